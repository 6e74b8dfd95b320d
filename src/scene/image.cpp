#include "image.hpp"

#include <algorithm>
#include <cstdarg>
#include <cstring>

namespace qray::scene {

namespace {

class Decoder {
public:
    Decoder(uint8_t* file, size_t bytes, ImageSource& into, char (&to)[100])
        : at(file), size(bytes), out(into), fault(to)
    {
    }

    bool decode()
    {
        if (size >= 2 && memcmp(at, "BM", 2) == 0)
            return bmp();
        if (size >= 2 && memcmp(at, "P6", 2) == 0)
            return ppm();
        return size == 0 ? is("is empty") : is("is neither of these");
    }

private:
    uint8_t* const at;
    const size_t size;
    ImageSource& out;
    char (&fault)[100];

    [[gnu::format(printf, 2, 3)]] bool is(const char* format, ...)
    {
        va_list values;
        va_start(values, format);
        vsnprintf(fault, sizeof fault, format, values);
        va_end(values);
        return false;
    }

    bool edges(uint32_t width, uint32_t height)
    {
        if (width == 0 || height == 0)
            return is("has %u x %u texels", width, height);
        if (width > Limits::image_size || height > Limits::image_size)
            return is("has %u x %u texels, more than %u each way (limit 'image_size')", width, height,
                      Limits::image_size);
        out.width = width;
        out.height = height;
        return true;
    }
    bool has(size_t first, size_t bytes)
    {
        return first + bytes <= size
            || is("is short: it has %zu bytes, and its texels end at %zu", size, first + bytes);
    }
    void turn_over()
    {
        const size_t row = 3 * size_t{out.width};
        for (size_t low = 0, high = out.height - 1u; low < high; low++, high--)
            std::swap_ranges(at + low * row, at + (low + 1) * row, at + high * row);
    }

    uint32_t word(size_t offset) const
    {
        return uint32_t{at[offset]} | uint32_t{at[offset + 1]} << 8 | uint32_t{at[offset + 2]} << 16
            | uint32_t{at[offset + 3]} << 24;
    }
    bool bmp()
    {
        constexpr uint32_t header = 40;
        if (size < 14 + header)
            return is("is short: it has %zu bytes, less than the header of a BMP", size);
        const uint32_t first = word(10), width = word(18), height = word(22);
        const uint32_t bits = word(28) & 0xffff, method = word(30);
        if (word(14) < header)
            return is("has a header of %u bytes, not %u or more", word(14), header);
        if (bits != 24)
            return is("is a BMP of %u bits a pixel", bits);
        if (method != 0)
            return is("is a BMP that is compressed, by method %u", method);
        const bool from_top = height >> 31 != 0;
        if (!edges(width, from_top ? 0 - height : height))
            return false;
        const size_t row = 3 * size_t{out.width}, padded = (row + 3) / 4 * 4;
        if (!has(first, padded * (out.height - 1u) + row))
            return false;
        // What is still to be read lies behind what is written, but for a header that the pixels overlap.
        if (first < 14 + header)
            return is("has pixels in its header");
        for (size_t j = 0; j < out.height; j++)
            for (size_t i = 0; i < row; i += 3) {
                const uint8_t* const bgr = at + first + j * padded + i;
                const uint8_t rgb[] = {bgr[2], bgr[1], bgr[0]};
                memcpy(at + j * row + i, rgb, sizeof rgb);
            }
        if (from_top)
            turn_over();
        return true;
    }

    static bool is_space(uint8_t c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
    // A number of a PPM's header, behind white space and comments; too large a one is cut to 99999999.
    bool number(size_t& next, uint32_t& value)
    {
        const size_t before = next;
        for (bool comment = false; next < size && (comment || is_space(at[next]) || at[next] == '#'); next++)
            comment = (comment || at[next] == '#') && at[next] != '\n';
        value = 0;
        const size_t digits = next;
        for (; next < size && at[next] >= '0' && at[next] <= '9'; next++)
            value = std::min(10 * value + (at[next] - uint32_t{'0'}), 99'999'999u);
        return (digits > before && next > digits) || is("is a PPM whose header ends at byte %zu", digits);
    }
    bool ppm()
    {
        size_t next = 2;
        uint32_t width = 0, height = 0, white = 0;
        if (!number(next, width) || !number(next, height) || !number(next, white))
            return false;
        if (white == 0 || white > 255)
            return is("is a PPM of values up to %u, not 1 to 255", white);
        if (!edges(width, height))
            return false;
        const size_t bytes = 3 * size_t{out.width} * out.height;
        if (next < size && !is_space(at[next])) // one white space, and no more
            return is("is a PPM whose header ends at byte %zu", next);
        next++;
        if (!has(next, bytes))
            return false;
        for (size_t i = 0; i < bytes; i++)
            at[i] = static_cast<uint8_t>((std::min<uint32_t>(at[next + i], white) * 510 + white) / (2 * white));
        turn_over();
        return true;
    }
};

} // namespace

bool decode_image(uint8_t* file, size_t size, ImageSource& out, char (&fault)[100])
{
    return Decoder(file, size, out, fault).decode();
}

} // namespace qray::scene
