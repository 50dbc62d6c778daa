#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/runs/run.hpp"
#include "bench/runs/table_jobs.hpp"
#include "results/table.hpp"

namespace drape::bench {

/// Methods that were asked for; none: all, or what the study thinks best.
using Methods = std::vector<const solver::Method*>;

/// All methods if none were asked for.
Methods all_or(Methods methods);

/// A study: a fixed question, answered by a list of runs or by tables. A row of the table, in a file of its own under
/// bench/studies/. quick: a short form for tests.
struct Study {
  std::string_view name;
  std::string_view description;
  std::vector<Group> (*groups)(bool quick) = nullptr;                                 ///< runs, compared with references
  std::vector<TableJob> (*tables)(bool quick) = nullptr;                              ///< or tables
  std::vector<TableJob> (*of_methods)(bool quick, const Methods& methods) = nullptr;  ///< or tables of any methods
  std::vector<TableJob> (*of_scene)(const model::Scene& scene, bool quick,
                                    const Methods& methods) = nullptr;  ///< the same about another scene

  /// Whether one may choose its methods.
  bool takes_methods() const { return groups != nullptr || of_methods != nullptr; }
};

/// All studies.
std::span<const Study> studies();

/// The study with this name. Throws std::invalid_argument, naming all that there are.
const Study& study(std::string_view name);

std::vector<Group> motions(bool quick);
std::vector<Group> hung_sheets(bool quick);
std::vector<TableJob> convergence(bool quick);
std::vector<TableJob> orders(bool quick, const Methods& methods);
std::vector<TableJob> modes(bool quick, const Methods& methods);
std::vector<TableJob> references(bool quick);
std::vector<TableJob> peers(bool quick);
std::vector<TableJob> table_3_1(bool quick);
std::vector<TableJob> table_3_2(bool quick);
std::vector<TableJob> figure_3_2(bool quick);
std::vector<TableJob> figure_3_3(bool quick);
std::vector<TableJob> figure_4_3(bool quick);
std::vector<TableJob> scaling(bool quick);
std::vector<TableJob> stability(bool quick, const Methods& methods);
std::vector<TableJob> tolerance(bool quick, const Methods& methods);
std::vector<TableJob> work_precision(bool quick, const Methods& methods);
std::vector<TableJob> bars(bool quick);
std::vector<TableJob> choice(bool quick);
std::vector<TableJob> work_precision_of(const model::Scene& scene, bool quick, const Methods& methods);

}  // namespace drape::bench
