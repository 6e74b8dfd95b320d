#include "plan.hpp"

#include "options.hpp"

namespace qray::cli {

int plan_main(int argc, char** argv)
{
    Options options;
    const int status = read_options(Command::plan, argc, argv, options);
    return status != go_on ? status : bad_options("'plan' does not work yet");
}

} // namespace qray::cli
