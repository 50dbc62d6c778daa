#include "results/analysis/work_precision.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <stdexcept>

#include "solver/base/statistics.hpp"

namespace drape::results {
namespace {

bool solved(const Measured& candidate) { return std::isfinite(candidate.error) && !candidate.times.empty(); }

double resampled_median(const std::vector<double>& times, std::mt19937& random) {
  std::uniform_int_distribution<std::size_t> any(0, times.size() - 1);
  std::vector<double> sample;
  for (std::size_t k = 0; k < times.size(); ++k) sample.push_back(times[any(random)]);
  return base::quantile(sample, 0.5);
}

double median(const Measured& candidate) { return quartiles(candidate.times).median; }

}  // namespace

Quartiles quartiles(const std::vector<double>& times) {
  if (times.empty()) throw std::invalid_argument("no times, no quartiles");
  return {base::quantile(times, 0.25), base::quantile(times, 0.5), base::quantile(times, 0.75)};
}

bool tied(const Measured& a, const Measured& b) {
  const Quartiles p = quartiles(a.times), q = quartiles(b.times);
  return p.lower <= q.upper && q.lower <= p.upper;
}

Interval ratio_of_medians(const Measured& a, const Measured& b) {
  constexpr int samples = 2000;
  std::mt19937 random(1);
  std::vector<double> ratios;
  for (int k = 0; k < samples; ++k) {
    const double above = resampled_median(a.times, random);
    ratios.push_back(above / resampled_median(b.times, random));
  }
  return {base::quantile(ratios, 0.025), base::quantile(ratios, 0.975)};
}

std::optional<std::size_t> quickest(std::span<const Measured> candidates, double error) {
  std::optional<std::size_t> best;
  for (std::size_t k = 0; k < candidates.size(); ++k)
    if (solved(candidates[k]) && candidates[k].error <= error && (!best || median(candidates[k]) < median(candidates[*best])))
      best = k;
  return best;
}

std::vector<std::size_t> near_quickest(std::span<const Measured> candidates, std::span<const double> errors, double slack) {
  std::set<std::size_t> near;
  for (const double error : errors)
    if (const auto best = quickest(candidates, error))
      for (std::size_t k = 0; k < candidates.size(); ++k)
        if (solved(candidates[k]) && candidates[k].error <= error && median(candidates[k]) <= slack * median(candidates[*best]))
          near.insert(k);
  return {near.begin(), near.end()};
}

}  // namespace drape::results
