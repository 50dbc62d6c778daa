#pragma once

#include <stdexcept>
#include <string>

#include "bench/strips/problem.hpp"
#include "solver/state.hpp"

namespace drape::bench::strips {

/// What is to be installed, in one line, before strips run; empty if it is there.
std::string missing();

/// A run that has not come to its end; the message is that of the program.
class StripsError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct StripsRun {
  Solved solved;
  solver::State end;  ///< empty unless the problem asks for it
};

/// Runs the program bench_strips in this number of processes on this machine. Throws std::invalid_argument with missing(), and
/// StripsError if it fails or takes longer than `limit` [s].
StripsRun run_strips(const Problem& problem, int processes, double limit);

}  // namespace drape::bench::strips
