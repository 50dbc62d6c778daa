#include "results/work_precision.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace drape::results {
namespace {

bool solved(const Measured& candidate) { return std::isfinite(candidate.error) && !candidate.times.empty(); }

double median(const Measured& candidate) { return quartiles(candidate.times).median; }

}  // namespace

Quartiles quartiles(std::vector<double> times) {
  if (times.empty()) throw std::invalid_argument("no times, no quartiles");
  std::ranges::sort(times);
  const auto at = [&](double part) {
    const double place = part * static_cast<double>(times.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, times.size() - 1);
    return std::lerp(times[below], times[above], place - static_cast<double>(below));
  };
  return {at(0.25), at(0.5), at(0.75)};
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
