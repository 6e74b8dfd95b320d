#pragma once

namespace qray::cli {

// qray compile: argv[0] is "compile"; returns the exit status.
int compile_main(int argc, char** argv);

} // namespace qray::cli
