#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "bench/runs/recording.hpp"
#include "bench/runs/run.hpp"

namespace drape::bench {

/// Methods that were asked for; none: all, or what the study thinks best.
using Methods = std::vector<const solver::Method*>;

/// All methods if none were asked for.
Methods all_or(Methods methods);

/// All that converge if none were asked for.
Methods converging_or(Methods methods);

/// What one asks a study.
struct Question {
  bool quick = false;                      ///< a short form for tests
  Methods methods = {};                    ///< for studies of any methods
  std::optional<model::Scene> scene = {};  ///< for studies of any scene; without one they have their own
};

/// A study: a fixed question, answered by groups of runs, compared with references, or by jobs that make tables. A row of the
/// table, in a file of its own under bench/studies/.
struct Study {
  using Runs = std::vector<Group> (*)(const Question& question);
  using Tables = std::vector<Job> (*)(const Question& question);

  std::string_view name;
  std::string_view description;
  std::variant<Runs, Tables> answer;
  bool any_methods = false;  ///< whether one may choose its methods
  bool any_scene = false;    ///< whether one may choose its scene

  bool makes_runs() const { return std::holds_alternative<Runs>(answer); }
};

/// All studies.
std::span<const Study> studies();

/// The study with this name. Throws std::invalid_argument, naming all that there are.
const Study& study(std::string_view name);

std::vector<Group> motions(const Question& question);
std::vector<Group> hung_sheets(const Question& question);
std::vector<Job> convergence(const Question& question);
std::vector<Job> orders(const Question& question);
std::vector<Job> modes(const Question& question);
std::vector<Job> references(const Question& question);
std::vector<Job> peer_study(const Question& question);
std::vector<Job> sundials_setups(const Question& question);
std::vector<Job> table_3_1(const Question& question);
std::vector<Job> table_3_2(const Question& question);
std::vector<Job> figure_3_2(const Question& question);
std::vector<Job> figure_3_3(const Question& question);
std::vector<Job> figure_4_3(const Question& question);
std::vector<Job> table_5_1(const Question& question);
std::vector<Job> detection(const Question& question);
std::vector<Job> contact(const Question& question);
std::vector<Job> conditioning(const Question& question);
std::vector<Job> limits(const Question& question);
std::vector<Job> memory(const Question& question);
std::vector<Job> fabrics(const Question& question);
std::vector<Job> drape_study(const Question& question);
std::vector<Job> garments(const Question& question);
std::vector<Job> scaling(const Question& question);
std::vector<Job> strips_study(const Question& question);
std::vector<Job> stability(const Question& question);
std::vector<Job> stages(const Question& question);
std::vector<Job> step_control(const Question& question);
std::vector<Job> tolerance(const Question& question);
std::vector<Job> work_precision(const Question& question);
std::vector<Job> bars(const Question& question);
std::vector<Job> choice(const Question& question);
std::vector<Job> sizes(const Question& question);
std::vector<Job> automatic_study(const Question& question);
std::vector<Job> field_study(const Question& question);
std::vector<Job> claims(const Question& question);

}  // namespace drape::bench
