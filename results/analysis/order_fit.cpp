#include "results/analysis/order_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "results/run_record.hpp"
#include "results/verdict.hpp"
#include "solver/base/statistics.hpp"

namespace drape::results {
namespace {

constexpr int fewest = 4;
constexpr double steadiness = 0.1, tolerance = 0.1;

}  // namespace

std::optional<OrderFit> fit_order(std::span<const double> h, std::span<const double> errors, double uncertainty) {
  const int n = static_cast<int>(errors.size());
  const auto usable = [&](int k) { return std::isfinite(errors[k]) && errors[k] > 0 && errors[k] >= resolution * uncertainty; };
  std::optional<OrderFit> best;
  for (int first = 0; first + fewest <= n; ++first) {
    double lowest = INFINITY, highest = -INFINITY;
    for (int last = first; last < n && usable(last); ++last) {
      if (last == first) continue;
      const double local = base::exponent(h[last - 1], errors[last - 1], h[last], errors[last]);
      lowest = std::min(lowest, local), highest = std::max(highest, local);
      if (!(highest - lowest <= steadiness)) break;
      const int count = last - first + 1;
      if (count >= fewest && (!best || count >= best->last - best->first + 1))
        best = OrderFit{base::exponent(h.subspan(first, count), errors.subspan(first, count)), lowest, highest, first, last};
    }
  }
  return best;
}

Verdict order_verdict(const std::optional<OrderFit>& fit, double declared) {
  if (!fit) return Verdict{Standing::open, "no order to be seen"};
  if (std::abs(fit->order - declared) <= tolerance) return Verdict{Standing::met, fmt::format("{:g} as declared", declared)};
  return Verdict{Standing::missed, fmt::format("not {:g}", declared)};
}

std::string spread(const OrderFit& fit) { return fmt::format("{:.3f} … {:.3f}", fit.lowest, fit.highest); }

}  // namespace drape::results
