#include "renderer.hpp"

const qray::cli::Renderer qray::cli::q24_renderer = RendererOf<q24>::renderer;
