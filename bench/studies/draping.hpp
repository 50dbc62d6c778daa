#pragma once

#include <optional>

#include "model/scene.hpp"
#include "results/run_record.hpp"
#include "results/table_builder.hpp"

namespace drape::bench {

/// What the thesis printed of a run: of another machine, and of a cloth whose scale of d it leaves open.
struct Printed {
  std::int64_t updates, cg_iterations;
  std::optional<double> seconds;
};

/// The columns of a run of a falling sheet in the current row: work, how far the corners sink, contacts, and the thesis'
/// figures.
void add_draping(results::TableBuilder& table, const model::Scene& scene, const results::RunRecord& run,
                 const std::optional<Printed>& thesis);

}  // namespace drape::bench
