#include "renderer.hpp"

template struct qray::cli::Kernel<qray::q32>;
const qray::cli::Renderer qray::cli::q32_renderer = RendererOf<q32>::renderer;
