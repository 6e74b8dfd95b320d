#include "renderer.hpp"

template struct qray::cli::Kernel<qray::Float>;
const qray::cli::Renderer qray::cli::float_renderer = RendererOf<Float>::renderer;
