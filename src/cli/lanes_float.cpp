#include "renderer.hpp"

#if QRAY_LANES
const qray::cli::Renderer qray::cli::float_lanes_renderer = RendererOf<Float>::renderer;
#endif
