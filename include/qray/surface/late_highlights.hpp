// Highlights that wait until all lights have been asked: on a desktop, in vectors' registers.
#pragma once

#include "highlight.hpp"

namespace qray {

// A material's highlights by several lights: in a register, the powers of four take as long as that of one.
template <class N>
struct LateHighlights {
    static constexpr bool pays = false;
};
#if QRAY_LANES
template <FloatLanes N>
struct LateHighlights<N> {
    static constexpr bool pays = true;

    QRAY_INLINE void add(const Highlight<N>& h, typename N::Unit cosine, typename N::Unit share, const Rgb<N>& colour,
                         Rgb<N>& sum)
    {
        if (!(h.amount > 0) || (cosine == 0 && h.shine.fraction > 0))
            return;
        if (count == most)
            finish(h, sum);
        cosines = Float4{cosine, cosines[0], cosines[1], cosines[2]};
        shares[count] = share;
        colours[count++] = &colour;
    }
    QRAY_INLINE void finish(const Highlight<N>& h, Rgb<N>& sum)
    {
        if (count == 0)
            return;
        Float4 powers = N::power_whole(cosines, h.shine);
        if (h.shine.fraction > 0) {
            const Float4 two = lane_min(cosines, lane_turned<2>(cosines)), least = lane_min(two, lane_turned<1>(two));
            powers *= N::power_fraction(cosines, least[0], h.shine.fraction);
        }
        for (uint32_t i = 0; i < count; i++)
            add_scaled<N>(sum, h.amount * powers[count - 1 - i] * shares[i], *colours[i]);
        cosines = Float4{1, 1, 1, 1};
        count = 0;
    }

private:
    static constexpr uint32_t most = 4;
    Float4 cosines{1, 1, 1, 1}; // the last first
    uint32_t count = 0;
    typename N::Unit shares[most]; // of the light that comes through
    const Rgb<N>* colours[most];
};
#endif

} // namespace qray
