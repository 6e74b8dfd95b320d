// What tracer.hpp declares, for all tests.
#define QRAY_ONCE
#include "tracer.hpp"
