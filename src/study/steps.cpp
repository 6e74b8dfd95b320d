// Firmware that says what each step takes on a board: ticks of many calls of the operations that the tracer has for it,
// with the loads of what it takes and the stores of what it finds. QRAY_NUMBER is the number system, in fixed point.
#include "steps.hpp"

#include <qray/qray.hpp>

#include "boards/common/board.hpp"

namespace qray::study {

namespace {

using N = QRAY_NUMBER;
constexpr int calls = 2000;

template <class F>
constexpr F of(int thousandths)
{
    return {static_cast<int32_t>(int64_t{thousandths} * (int64_t{1} << F::frac) / 1000)};
}
template <class F>
constexpr Vec<F> of(int x, int y, int z)
{
    return {of<F>(x), of<F>(y), of<F>(z)};
}

// What a light map asks of a scene.
struct LightTables {
    Table<LightCell<N>, true> light_cells;
    Table<LightKnot<N>, true> light_knots;
    Table<LightCut<N>, true> light_cuts;
    Table<LightPlane<N>, true> light_planes;
};

// A ball of radius 1, and a ray that meets it; numbers that a compiler does not see.
struct Operands {
    Sphere<N> ball{};
    Point<N> to_ball = of<N::Length>(6000, 7200, 7400), near = of<N::Length>(100, -200, 300);
    Point<N> hit = of<N::Length>(480, -600, 640);
    Direction<N> d = of<N::Unit>(480, 600, 640), n = of<N::Unit>(-600, -640, -480), out = d;
    Pencil<N> pencil{};
    N::Length middle = of<N::Length>(12000), half = of<N::Length>(900), t{};
    N::Unit u = of<N::Unit>(-979), v = of<N::Unit>(700), w{};
    N::Area area{};
    N::Eta eta = of<N::Eta>(667);
    N::Shine shine{20, 0};
    Light<N> lamp{of<N::Length>(9000, 20000, -7000), 0, {}};
    Rgb<N> colour = of<N::Colour>(500, 600, 700), sum = of<N::Colour>(100, 200, 300), light{};
    LatticeAxis<N> axis{};
    Cell<N> cell{};
    LightAxis<N> axis_of_map{{}, 255, LightAxis<N>::even};
    LightMap<N> map{axis_of_map, axis_of_map, {}, 2, 2, 0, LightMap<N>::whole, 0};
    LightCell<N> cells[12]{}; // of four nodes
};
constinit Operands operands;

// What a step is in the tracer.
struct Calls {
    static void nothing(Operands&) {}
    static void camera(Operands& o) { o.pencil.unit(o.out); }
    static constexpr auto coordinate = nothing, eta = nothing, row = nothing; // on the desktop
    static constexpr auto share = nothing;                                     // with colours
    static void projection(Operands& o) { o.t = N::length(dot<N>(o.to_ball, o.d)); }
    static void perpendicular(Operands& o)
    {
        o.near = fine_offset<N>(o.middle, o.d, o.to_ball, o.ball.fine);
        o.area = norm2<N>(o.near);
    }
    static void root(Operands& o) { o.half = N::root(o.area); }
    static void quotient(Operands& o) { N::quotient(dot<N>(o.to_ball, o.n), dot<N>(o.d, o.n), 0, o.t); }
    static void t(Operands& o) { o.t = o.middle - N::coarse(o.half, o.ball.fine); }
    static void point(Operands& o) { o.hit = o.to_ball + along<N>(o.middle, o.d); }
    static void normal(Operands& o) { sharpen<N>(o.out); }
    static void curved(Operands& o) { o.out = ratio<N>(o.near, o.ball.inverse_radius); }
    static void mirrored(Operands& o) { o.out = qray::mirrored<N>(o.d, o.n, o.u); }
    static void refracted(Operands& o) { qray::refracted<N>(o.d, o.n, o.u, o.eta, o.out); }
    static void light(Operands& o) { towards(o.lamp, o.hit, o.out, o.t); }
    static void cosine(Operands& o) { o.u = N::unit(dot<N>(o.n, o.d)); }
    static void power(Operands& o) { o.w = N::power_whole(o.v, o.shine); }
    static void texture(Operands& o) { o.cell = o.axis.cell(o.hit); }
    static void colour(Operands& o)
    {
        o.light = o.sum;
        add_scaled<N>(o.light, o.v, o.colour);
    }
    static void map(Operands& o) { o.light = o.map.at<8>(o.hit, LightTables{{o.cells, 12}, {}, {}, {}}); }
    static void weight(Operands& o) { o.w = N::unit(o.v * o.u); }
};

template <void (*F)(Operands&)>
QRAY_NOINLINE void measure(const char* name)
{
    const Operands fresh = operands;
    const uint64_t before = board::ticks();
    for (int i = 0; i < calls; i++) {
        __asm__ volatile("" ::"r"(&operands) : "memory");
        F(operands);
    }
    __asm__ volatile("" ::"r"(&operands) : "memory");
    const uint64_t after = board::ticks();
    operands = fresh;
    board::say(name);
    board::say(": ");
    board::say_hex(static_cast<uint32_t>(after - before));
    board::say("\n");
}

} // namespace

} // namespace qray::study

int main()
{
    using namespace qray::study;
    const auto size = [](int fine) { return qray::study::N::Length{(1 << N::Length::frac) << fine}; };
    if (!qray::set_radius(operands.ball, size))
        return 1;
    operands.area = operands.ball.radius * operands.half;
    const auto set = [](auto& pencil, auto& axis) {
        pencil.x = pencil.y = pencil.z = decltype(pencil.x){1} << (8 * sizeof pencil.x - 5);
        axis.row_x = 0x12345;
        axis.row_y = 0x23456;
        axis.row_z = 0x1234;
        if constexpr (requires { axis.frac; })
            axis.frac = 20;
    };
    set(operands.pencil, operands.axis);
    board::start_ticks();
    board::say("calls: ");
    board::say_hex(calls);
    board::say("\n");
    measure<Calls::nothing>("nothing");
#define QRAY_MEASURE(name, quantity, what) measure<Calls::name>(#name);
    QRAY_STEPS(QRAY_MEASURE)
    return 0;
}
