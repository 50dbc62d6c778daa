#include <fmt/format.h>

#include <algorithm>

#include "bench/studies/scaling/scaling.hpp"
#include "bench/studies/target.hpp"
#include "results/columns.hpp"
#include "solver/base/statistics.hpp"

namespace drape::bench::scaling_study {
namespace {

/// What a BDF(2) step of the large sheet costs a particle over what the same step of the small one costs. After each of the
/// large one the small one is run several times over, for its steps are short, and in turns, because the machine's speed
/// drifts.
std::vector<double> growth(int large, int small) {
  constexpr int copies = 5, steps = 5;
  const model::Cloth big = hung_sheet(large), little = hung_sheet(small);
  std::vector<double> small_times;
  StepClock clock([&](int count) {
    if (count <= first_steps) return;
    std::vector<double> times;
    for (int k = 0; k < copies; ++k) {
      StepClock own;
      run_steps(small, "bdf2", little, count, own);
      times.push_back(own.times.back());
    }
    small_times.push_back(base::quantile(times, 0.5));
  });
  run_steps(large, "bdf2", big, first_steps + steps, clock);
  std::vector<double> ratios;
  for (int k = 0; k < steps; ++k)
    ratios.push_back(clock.times[first_steps + k] / big.ode.particles() / (small_times[k] / little.ode.particles()));
  return ratios;
}

/// What the forces of the sheet (tension, damping, shear, weight) cost a particle [ns].
std::vector<double> force_times(int n) {
  constexpr int turns = 21;
  const model::Cloth cloth = hung_sheet(n);
  solver::Vectors f(cloth.ode.particles(), 3);
  std::vector<double> times;
  for (int k = 0; k < turns; ++k) {
    const double time = seconds([&] { cloth.ode.force(0, cloth.start.x, cloth.start.v, f); });
    times.push_back(1e9 * time / cloth.ode.particles());
  }
  return times;
}

/// A target, and what was measured in some turns.
struct Asked {
  std::string what;
  Target target;
  std::vector<double> values;

  double value() const { return base::quantile(values, 0.5); }
};

using results::ColumnOf;
using results::Datum;
using results::Role;

constexpr ColumnOf<Asked> bar_columns[] = {
    {"what", "target", "", "what is compared", Role::key, results::field<&Asked::what>},
    {"bar", "target value", "", "bound of the value", Role::key,
     [](const Asked& asked) -> Datum { return to_string(asked.target); }},
    {"value", "value", "1", "median of turns", Role::time, [](const Asked& asked) -> Datum { return asked.value(); }},
    {"lowest", "from", "1", "lowest of turns", Role::time,
     [](const Asked& asked) -> Datum { return std::ranges::min(asked.values); }},
    {"highest", "to", "1", "highest of turns", Role::time,
     [](const Asked& asked) -> Datum { return std::ranges::max(asked.values); }},
    {"verdict", "verdict", "", "whether the target is met", Role::verdict,
     [](const Asked& asked) -> Datum { return check(asked.target, asked.value()); }},
};

std::vector<Asked> asked(bool quick, Checkpoint& checkpoint) {
  const int large = sizes(quick).back(), small = quick ? 20 : 100;
  std::vector<Asked> rows;
  checkpoint.show("bars: a step");
  rows.push_back({fmt::format("BDF(2) step: time per particle, {0} x {0} over {1} x {1}", large, small),
                  {3, false},
                  checkpoint.timed("step", [&] { return growth(large, small); })});
  checkpoint.advance();
  checkpoint.show("bars: conjugate gradients");
  rows.push_back({fmt::format("fused CG and stencil: bandwidth over the triad's, {0} x {0}", large),
                  {0.6, true},
                  checkpoint.timed("iteration", [&] { return bandwidth_of_bare_iterations(large, 31); })});
  checkpoint.advance();
  checkpoint.show("bars: forces");
  rows.push_back({fmt::format("forces: ns per particle, {0} x {0}", large), {8, false}, checkpoint.timed("forces", [&] {
                    return force_times(large);
                  })});
  checkpoint.advance();
  return rows;
}

results::Table asked_table(const std::vector<Asked>& rows) {
  return results::make_table("scaling-bars", "Targets, one thread", bar_columns, rows);
}

}  // namespace

Job bars(bool quick) {
  return job(
      "scaling-bars", 3, [quick](Checkpoint& checkpoint) { return asked(quick, checkpoint); }, asked_table);
}

}  // namespace drape::bench::scaling_study
