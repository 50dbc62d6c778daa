#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "bench/runs/energy_guard.hpp"
#include "bench/studies/stability/stability.hpp"

namespace drape::bench {
namespace {

constexpr int particles = 10;       ///< a side
constexpr int most_parts = 1024;    ///< steps
constexpr double resolution = 0.1;  ///< of h*, relative

struct Softness {
  double k, d;
};

/// Finds the fewest equal steps to the horizon with which a method does well.
class FewestSteps {
 public:
  FewestSteps(const CompiledScene& sheet, const CrossCheckedReference& reference, const solver::Method& method,
              const solver::Options& options)
      : sheet_(sheet),
        reference_(reference),
        spec_{sheet.scene, "", &method, 0, options},
        limits_{.evaluations = usual_evaluations(method)} {}

  /// Where doubling the number first does well, bisected between there and the number before; 0 if none does.
  template <class Good>
  int fewest(const Good& good) {
    int bad = 0, enough = 1;
    for (; !good((*this)(enough)); enough *= 2) {
      if (enough == most_parts) return 0;
      bad = enough;
    }
    while (enough - bad > 1 && enough - bad > resolution * bad) {
      const int middle = (bad + enough) / 2;
      (good((*this)(middle)) ? enough : bad) = middle;
    }
    return enough;
  }

 private:
  const ClassifiedRun& operator()(int steps) {
    auto known = known_.find(steps);
    if (known == known_.end()) {
      spec_.step = horizon / steps;
      known = known_.emplace(steps, classified(run_guarded(spec_, sheet_.cloth, limits_), reference_)).first;
    }
    return known->second;
  }

  const CompiledScene& sheet_;
  const CrossCheckedReference& reference_;
  RunSpec spec_;
  const Limits limits_;
  std::map<int, ClassifiedRun> known_;
};

/// A step that the solver had to cut is not the one that was asked for.
bool uncut(const ClassifiedRun& run) { return run.end.result.rejected_steps == 0; }

/// What a method does on one sheet.
struct StepLimits {
  double k, d;
  std::string method;
  LargestSteps largest;
  double uncertainty;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StepLimits, k, d, method, largest, uncertainty)

using results::Role;
constexpr results::ColumnOf<StepLimits> limits_columns[] = {
    {"tension", "k", "N/m", "tension modulus", Role::key, results::field<&StepLimits::k>},
    {"damping", "d", "N s/m", "damping, linear", Role::key, results::field<&StepLimits::d>},
    {"method", "method", "", "time integrator", Role::key, results::field<&StepLimits::method>},
};
constexpr results::ColumnOf<StepLimits> limits_uncertainty[] = {
    {"uncertainty", "±", "1", "how far the two reference methods differ", Role::uncertainty,
     results::field<&StepLimits::uncertainty>},
};

std::vector<StepLimits> step_limits(int n, const Softness& softness, const Methods& methods, Checkpoint& checkpoint) {
  const auto [k, d] = softness;
  const CompiledScene sheet = hung_by_corners(n, k, d);
  std::optional<CrossCheckedReference> reference;  // made for the first row that no process before this one has made
  std::vector<StepLimits> rows;
  checkpoint.each(methods, [&, k = k, d = d](const solver::Method* method) {
    rows.push_back(checkpoint.once(fmt::format("{} {} {}", k, d, method->name), [&, k = k, d = d] {
      if (!reference) reference.emplace(sheet);
      return StepLimits{k, d, std::string(method->name), largest_steps(sheet, *reference, *method, {}),
                        reference->uncertainty()};
    }));
  });
  return rows;
}

results::Table step_limits_table(const std::vector<StepLimits>& rows) {
  results::Table table =
      results::make_table("stability-steps",
                          fmt::format("The largest usable step of every method by bisection, at least {:.2g} s, to {} s",
                                      horizon / most_parts, horizon),
                          limits_columns, rows);
  results::add_columns(table, largest_columns, rows, [](const StepLimits& row) { return &row.largest; });
  results::add_columns(table, limits_uncertainty, rows);
  return table;
}

}  // namespace

LargestSteps largest_steps(const CompiledScene& sheet, const CrossCheckedReference& reference, const solver::Method& method,
                           const solver::Options& options) {
  FewestSteps search(sheet, reference, method, options);
  const auto step = [](int steps) { return steps > 0 ? horizon / steps : 0; };
  const int accurate =
      search.fewest([](const ClassifiedRun& run) { return uncut(run) && run.classification == Classification::accurate; });
  return {step(accurate), step(search.fewest([](const ClassifiedRun& run) { return uncut(run) && run.stable(); }))};
}

Job largest_steps(bool quick, const Methods& methods) {
  const std::vector<Softness> sheets =
      quick ? std::vector<Softness>{{1e4, 50}} : std::vector<Softness>{{1e4, 50}, {1e4, 5}, {1e4, 0.5}, {1e6, 5}};
  const auto compute = [=](Checkpoint& checkpoint) {
    std::vector<StepLimits> rows;
    checkpoint.each(sheets, [&](const Softness& sheet) {
      checkpoint.show(fmt::format("largest steps, k = {}, d = {}", sheet.k, sheet.d));
      std::ranges::move(step_limits(quick ? 6 : particles, sheet, all_or(methods), checkpoint), std::back_inserter(rows));
      checkpoint.advance();
    });
    return rows;
  };
  return job("stability-steps", static_cast<int>(sheets.size()), compute, step_limits_table);
}

}  // namespace drape::bench
