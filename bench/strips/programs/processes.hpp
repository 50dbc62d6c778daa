#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bench/strips/problem.hpp"

namespace drape::bench::strips {

/// MPI and hypre from begin to end of the program. All that follows uses MPI_COMM_WORLD.
class Processes {
 public:
  Processes(int* argc, char*** argv);
  Processes(const Processes&) = delete;
  Processes& operator=(const Processes&) = delete;
  ~Processes();

  static int rank();
  static int count();

  /// The largest of all.
  static double largest(double here);

  /// Adds what the others have, process by process, so that the sum does not depend on how messages travel.
  static void add_up(std::span<double> sums);

  /// The values of all, process by process; each has as many.
  static std::vector<double> gathered(std::span<const double> here);
};

/// What this process has sent until now: calls of MPI by all libraries are counted on their way.
Traffic traffic();

}  // namespace drape::bench::strips
