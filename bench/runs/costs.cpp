#include "bench/runs/costs.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

#include "solver/base/statistics.hpp"
#include "solver/base/stopwatch.hpp"
#include "solver/contact/pair_search.hpp"

namespace drape::bench {
namespace {

/// The same function, whose time is added to a sum. It sets its last arguments and may be called within another.
template <class... Arguments>
void measure(std::function<void(Arguments...)>& function, double& sum) {
  if (!function) return;
  function = [function = std::move(function), &sum](Arguments... arguments) {
    const base::Stopwatch stopwatch(&sum);
    function(std::forward<Arguments>(arguments)...);
  };
}

/// The same search, whose time is added to a sum.
class MeasuredSearch : public solver::PairSearch {
 public:
  MeasuredSearch(std::shared_ptr<PairSearch> search, double& sum) : search_(std::move(search)), sum_(sum) {}
  void begin(double t, double h) override {
    const base::Stopwatch stopwatch(&sum_);
    search_->begin(t, h);
  }
  const solver::BodyPoints& bodies() const override { return search_->bodies(); }
  bool rubs() const override { return search_->rubs(); }
  void find(const solver::Vectors& x0, const solver::Vectors& x1, double part,
            std::vector<solver::PairContact>& found) override {
    const base::Stopwatch stopwatch(&sum_);
    search_->find(x0, x1, part, found);
  }
  void renew(const solver::Vectors& x, std::vector<solver::PairContact>& pairs) const override { search_->renew(x, pairs); }

 private:
  std::shared_ptr<PairSearch> search_;
  double& sum_;
};

}  // namespace

Costs costs(const RunSpec& spec, std::size_t most_steps) {
  const model::Cloth cloth = model::compile(spec.scene);
  Costs found;
  const EquationHook measure_parts = [&](solver::SplitOde& ode) {
    for (auto* force : {&ode.force, &ode.explicit_force, &ode.unconstrained_force}) measure(*force, found.forces);
    measure(ode.mean_excess, found.forces);
    measure(ode.jacobian, found.forces);
    measure(ode.newton_matrix, found.forces);
    measure(ode.contacts, found.detection);
    if (ode.pairs) ode.pairs = std::make_shared<MeasuredSearch>(ode.pairs, found.detection);
    ode.response_ms = &found.response;
  };
  Limits limits;
  limits.steps = most_steps;
  double whole = 0;
  {
    const base::Stopwatch stopwatch(&whole);
    run(spec, cloth, {}, limits, measure_parts);
  }
  found.rest = whole - found.forces - found.detection - found.response;
  return found;
}

std::vector<MedianCosts> median_costs(const Group& group, const std::vector<std::size_t>& steps, int repetitions) {
  std::vector<std::vector<Costs>> all(group.size());
  for (int repetition = 0; repetition < repetitions; ++repetition)
    for (std::size_t k = 0; k < group.size(); ++k) all[k].push_back(costs(group[k], steps[k]));
  std::vector<MedianCosts> found;
  for (std::size_t k = 0; k < group.size(); ++k) {
    const double seconds = static_cast<double>(steps[k]) * group[k].step;
    const auto median = [&](double Costs::*part) {
      std::vector<double> times;
      for (const Costs& one : all[k]) times.push_back(one.*part / seconds);
      return base::quantile(times, 0.5);
    };
    const auto [least, most] = std::ranges::minmax(all[k], {}, &Costs::total);
    found.push_back({{median(&Costs::forces), median(&Costs::detection), median(&Costs::response), median(&Costs::rest)},
                     (most.total() - least.total()) / seconds / 2});
  }
  return found;
}

}  // namespace drape::bench
