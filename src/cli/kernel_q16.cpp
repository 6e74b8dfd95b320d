#include "renderer.hpp"

const qray::cli::Renderer qray::cli::q16_renderer = RendererOf<q16>::renderer;
