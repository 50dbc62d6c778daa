#pragma once

#include <optional>

#include "bench/cell.hpp"
#include "results/table_builder.hpp"

namespace drape::bench {

/// A run of a sheet that falls on an obstacle, with what the thesis' tables look at.
struct Draping {
  results::RunRecord run;
  double drop = 0;      ///< by which the four corners have sunk, their mean [m]
  int constrained = 0;  ///< particles that touched something in the last step
};
Draping drape_once(const Cell& cell);

/// What the thesis printed of a run, on another machine, with scales of k and d that it leaves open.
struct Printed {
  std::int64_t updates, cg_iterations;
};

/// The columns of such a run in the current row. `solver_ms`: what it took, if that was measured.
void add_draping(results::TableBuilder& table, const Draping& draping, std::optional<double> solver_ms,
                 const std::optional<Printed>& thesis);

/// The median of at least one number.
double median(std::vector<double> numbers);

}  // namespace drape::bench
