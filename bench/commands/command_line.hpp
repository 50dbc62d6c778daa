#pragma once

namespace drape::bench {

/// The program bench_integrators. Returns its exit code: 0, or 2 after one line on standard error about bad input.
int run_command_line(int argc, const char* const* argv);

}  // namespace drape::bench
