// One number system of the page: page.mk compiles this for each of src/cli/kernel_*.cpp, with its name and its type.
#include "kernel.hpp"

namespace qray::page {

namespace {

using N = PAGE_TYPE;

void pixels(uint32_t x, uint32_t y, uint32_t stride, uint32_t count, uint8_t* rgb, cli::RayCounts& rays)
{
    const auto view = cli::storage_of<N>().template view<scene::desktop_effects()>();
    for (uint32_t i = 0; i < count; i++, x += stride)
        Rgb888::put(render_pixel(view, x, y, rays), x, y, rgb + 3 * i);
}

} // namespace

extern const Kernel PAGE_KERNEL;
const Kernel PAGE_KERNEL{PAGE_NAME, cli::build_scene<N>, pixels};

} // namespace qray::page
