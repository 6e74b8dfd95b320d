#include "renderer.hpp"

template struct qray::cli::Kernel<qray::q16>;
const qray::cli::Renderer qray::cli::q16_renderer = RendererOf<q16>::renderer;
