#include "renderer.hpp"

const qray::cli::Renderer qray::cli::float_renderer = RendererOf<Float>::renderer;
