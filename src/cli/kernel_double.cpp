#include "renderer.hpp"

const qray::cli::Renderer qray::cli::double_renderer = RendererOf<Double>::renderer;
