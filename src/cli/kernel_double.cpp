#include "renderer.hpp"

template struct qray::cli::Kernel<qray::Double>;
const qray::cli::Renderer qray::cli::double_renderer = RendererOf<Double>::renderer;
