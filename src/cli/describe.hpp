#pragma once

namespace qray::cli {

// qray --describe: what there is of each kind, as JSON, for scripts. Returns the exit status.
int describe();

} // namespace qray::cli
