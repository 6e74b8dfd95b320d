#include "renderer.hpp"

const qray::cli::Renderer qray::cli::q32_renderer = RendererOf<q32>::renderer;
