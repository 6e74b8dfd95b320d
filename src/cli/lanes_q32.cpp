#include "renderer.hpp"

#if QRAY_LANES
const qray::cli::Renderer qray::cli::q32_lanes_renderer = RendererOf<q32>::renderer;
#endif
