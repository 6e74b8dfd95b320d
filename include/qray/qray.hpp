// qray: everything a program needs to draw a compiled scene.
#pragma once

#include "picture/render.hpp"
