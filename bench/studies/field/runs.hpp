#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/studies/field/sheets.hpp"
#include "results/analysis/work_precision.hpp"

namespace drape::bench {

/// A method with the number that controls its accuracy, on a sheet.
struct FieldRun {
  std::string method;
  double value;              ///< step [s], or fraction of the stability limit of a method that divides its steps
  bool recommended = false;  ///< whether the value is the one that the study recommends to all without a look at the scene
  solver::Outcome outcome = solver::Outcome::success;
  std::string reason = {};       ///< why it did not succeed
  double error = NAN;            ///< largest at all tenths of the end, over the size; NaN: not known, as the following
  double lag = NAN;              ///< by which it is late [s]
  double lag_uncertainty = NAN;  ///< [s]
  double energy = NAN;           ///< largest difference of the total energy from the reference's, over the scale of that
  double energy_at_end = NAN;    ///< the same at the end, negative: it has lost energy
  double momentum = NAN, angular_momentum = NAN;  ///< largest differences of the momenta, as MotionErrorRecord has them
  std::int64_t steps = 0, systems = 0, evaluations = 0;
  std::vector<double> times = {};  ///< CPU times of its repetitions [ms]; one: of the first run

  bool counts() const { return outcome == solver::Outcome::success && std::isfinite(error); }
  bool timed() const { return times.size() > 1; }
  std::string_view family() const { return solver::method(method).family(); }
  std::string setting() const;  ///< "bdf2, h = 0.01 s", "verlet, 0.9 of its limit"
  results::Measured measured() const { return {error, times}; }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FieldRun, method, value, recommended, outcome, reason, error, lag, lag_uncertainty, energy,
                                   energy_at_end, momentum, angular_momentum, steps, systems, evaluations, times)

/// A sheet with all that was run on it.
struct SheetResult {
  FieldSheet sheet;
  double damping;       ///< [N s/m]
  double to_damping;    ///< h k/d at the recommended step; infinite without damping
  double uncertainty;   ///< of the errors, over the size; NaN: they are not known
  std::string missing;  ///< why there is no reference
  std::vector<FieldRun> runs = {};
};

/// Errors at which the quickest is asked for.
inline constexpr double field_errors[] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6};

/// Those that the reference of a sheet resolves.
std::vector<double> field_levels(const SheetResult& sheet);

/// Runs every method that can meet what is in the scene with every setting, from coarse to fine until one exceeds its limits,
/// and repeats those that are among the quickest of their method, all interleaved.
SheetResult run_sheet(const FieldSheet& sheet, const Methods& methods, Checkpoint& checkpoint);

}  // namespace drape::bench
