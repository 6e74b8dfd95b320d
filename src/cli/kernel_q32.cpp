#include "kernel.hpp"

template struct qray::cli::Kernel<qray::q32>;
