// What tracer.hpp declares of boards' scenes, for all sanitized tests.
#define QRAY_FLAT
#include "tracer.hpp"
