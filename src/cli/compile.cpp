#include "compile.hpp"

#include "options.hpp"

namespace qray::cli {

int compile_main(int argc, char** argv)
{
    Options options;
    const int status = read_options(Command::compile, argc, argv, options);
    return status != go_on ? status : bad_options("'compile' does not work yet");
}

} // namespace qray::cli
