#include <fmt/format.h>

#include <algorithm>

#include "bench/studies/method_check.hpp"

namespace drape::bench {
namespace {

std::string order_lines(const MethodCheck& check) {
  const RefinedRun &first = check.order.front(), &last = check.order.back();
  const results::FittedCurve& curve = *first.curve;
  return fmt::format("order      {} (declared {}): {}\n           {};\n           {} steps, {:g} to {:.2g} s\n",
                     curve.fit ? fmt::format("{:.2f}", curve.fit->order) : "none", check.method->order,
                     to_string(*curve.verdict), order_title(check), check.order.size(), first.step, last.step);
}

std::string seconds_or_none(double value) { return value > 0 ? fmt::format("{:.3g} s", value) : "none"; }

std::string stability_lines(const MethodCheck& check) {
  std::string lines = "stability  largest steps, hung by two corners, 10 x 10, k = 1e4, to 0.24 s\n";
  for (const Usable& row : check.stability)
    lines += fmt::format("           d = {:<4g} accurate {}, stable {}: {}; theory: {}\n", row.damping,
                         seconds_or_none(row.largest.accurate), seconds_or_none(row.largest.stable), to_string(row.verdict()),
                         row.theory);
  return lines;
}

std::string energy_lines(const MethodCheck& check) {
  std::string lines = "energy     undamped, 1 s; over the largest kinetic energy\n";
  for (const EnergyChange& row : check.energy)
    lines += fmt::format("           h = {:<6g} {}: {}\n", row.step,
                         row.change ? fmt::format("{:+.2g} at the end, at most {:+.2g}", *row.change, *row.gain)
                                    : std::string(to_string(row.outcome)),
                         to_string(row.verdict()));
  return lines;
}

bool is_quickest(const Cost& row, const std::vector<Cost>& all) {
  return std::ranges::none_of(all, [&](const Cost& other) {
    return other.wanted == row.wanted && other.best && other.best->times.median < row.best->times.median;
  });
}

/// The quickest at each error has a star.
std::string cost_lines(const MethodCheck& check) {
  std::string head, lines, method;
  for (const Cost& row : check.cost) {
    if (row.method != method) lines += fmt::format("{}           {:<18.18}", method.empty() ? "" : "\n", row.method);
    method = row.method;
    if (method == check.cost.front().method) head += fmt::format("{:>9.0e}       ", row.wanted);
    lines += row.best ? fmt::format("{:>8.3g}{}{:>7}", row.best->times.median, is_quickest(row, check.cost) ? '*' : ' ',
                                    row.best->forces)
                      : fmt::format("{:>16}", "-");
  }
  head.erase(head.find_last_not_of(' ') + 1);
  return fmt::format("cost       median ms (* the quickest) and evaluations of forces, d = 5, 0.3 s\n           {:<18}{}\n{}\n",
                     "error at most", head, lines);
}

}  // namespace

std::string summary(const MethodCheck& check) {
  return fmt::format("{}: {}\n\n{}{}{}{}", check.name, check.method->description, order_lines(check), stability_lines(check),
                     energy_lines(check), cost_lines(check));
}

}  // namespace drape::bench
