// What scene_helpers.hpp declares, for all tests.
#define QRAY_ONCE
#include "scene_helpers.hpp"
