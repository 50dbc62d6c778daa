#include "results/work_precision.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "results/runs_table.hpp"

namespace drape::results {
namespace {

bool solved(const Measured& candidate) { return std::isfinite(candidate.error) && !candidate.times.empty(); }

double median(const Measured& candidate) { return quartiles(candidate.times).median; }

}  // namespace

Quartiles quartiles(const std::vector<double>& times) {
  if (times.empty()) throw std::invalid_argument("no times, no quartiles");
  return {quantile(times, 0.25), quantile(times, 0.5), quantile(times, 0.75)};
}

bool tied(const Measured& a, const Measured& b) {
  const Quartiles p = quartiles(a.times), q = quartiles(b.times);
  return p.lower <= q.upper && q.lower <= p.upper;
}

std::vector<std::size_t> near_front(std::span<const Measured> candidates, double slack) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < candidates.size(); ++k)
    if (solved(candidates[k])) order.push_back(k);
  std::ranges::sort(order, {}, [&](std::size_t k) { return candidates[k].error; });

  std::vector<std::size_t> near;
  double least = INFINITY;  // time of all with a smaller or equal error
  for (const std::size_t k : order) {
    const double time = median(candidates[k]);
    if (time <= slack * least) near.push_back(k);
    least = std::min(least, time);
  }
  std::ranges::sort(near);
  return near;
}

std::optional<std::size_t> quickest(std::span<const Measured> candidates, double error) {
  std::optional<std::size_t> best;
  for (std::size_t k = 0; k < candidates.size(); ++k)
    if (solved(candidates[k]) && candidates[k].error <= error && (!best || median(candidates[k]) < median(candidates[*best])))
      best = k;
  return best;
}

}  // namespace drape::results
