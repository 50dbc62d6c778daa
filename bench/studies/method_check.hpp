#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/studies/refinement.hpp"
#include "bench/studies/stability/stability.hpp"
#include "results/analysis/work_precision.hpp"

namespace drape::bench {

/// Up to what steps a method is stable.
struct Usable {
  double damping;
  LargestSteps largest;
  std::string theory;

  results::Verdict verdict() const;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Usable, damping, largest, theory)

/// What a run makes of the energy of an undamped sheet.
struct EnergyChange {
  double step;
  solver::Outcome outcome;
  std::optional<double> change, gain;

  results::Verdict verdict() const;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EnergyChange, step, outcome, change, gain)

/// The quickest configuration of a method at an error.
struct Quickest {
  double value, error;  ///< step or fraction of the stability limit; of its run
  results::Quartiles times;
  std::int64_t forces;  ///< evaluations
};

/// What an error costs at least.
struct Cost {
  std::string method;
  double wanted;
  std::optional<Quickest> best;  ///< nothing if the method does not reach the error
};

/// What is measured of a method, with stage and linear solvers in its name or without:
/// - errors with ever smaller steps on a soft sheet, and the order beside the declared one
/// - the largest usable steps on a sheet hung by two corners, strongly and weakly damped, beside linear theory
/// - what it makes of the energy of an undamped sheet
/// - time and evaluations of forces at equal errors, beside usual methods
struct MethodCheck {
  std::string name;
  const solver::Method* method;
  std::vector<RefinedRun> order;
  std::vector<Usable> stability;
  std::vector<EnergyChange> energy;
  std::vector<Cost> cost;
};

/// Records it as the tables `check-order`, `check-stability`, `check-energy` and `check-cost`, with a summary. Throws
/// std::invalid_argument as choose_method() does.
Job method_check(const std::string& method);

/// Title of the table `check-order`.
std::string order_title(const MethodCheck& check);

/// The check on one screen.
std::string summary(const MethodCheck& check);

}  // namespace drape::bench
