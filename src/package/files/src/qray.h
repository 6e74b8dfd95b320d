// By this name Arduino finds the library.
#include "qray/qray.hpp"
