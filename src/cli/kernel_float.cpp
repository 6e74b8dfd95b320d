#include "kernel.hpp"

template struct qray::cli::Kernel<qray::Float>;
