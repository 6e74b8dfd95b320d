// qray: everything a program needs to draw a compiled scene.
#pragma once

#if __cplusplus < 201709L // what g++ 10 says with this flag
#error "qray needs C++20: give the compiler -std=c++20"
#include "qray needs -std=c++20" // ends the compilation, before hundreds of errors more
#endif

#define QRAY_VERSION 10000 // 1.0.0: two digits each

#include "picture/render.hpp"
#include "scene/look_at.hpp"
#include "scene/refit.hpp"
