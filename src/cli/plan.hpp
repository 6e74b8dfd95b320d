#pragma once

namespace qray::cli {

// qray plan: argv[0] is "plan"; returns the exit status.
int plan_main(int argc, char** argv);

} // namespace qray::cli
