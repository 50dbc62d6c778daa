#include "solver/base/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace drape::base {
namespace {

constexpr std::size_t most_exact = 30;

/// Pairs in which the time of b exceeds that of a; equal ones count half.
double rank_statistic(std::span<const double> a, std::span<const double> b) {
  double u = 0;
  for (const double x : a)
    for (const double y : b) u += y > x ? 1 : y == x ? 0.5 : 0;
  return u;
}

/// Probability of U >= u if all orders of n + m times are equally likely. ways[j][v]: in how many of them j times of b have
/// v times of a below them, summed; times of a are added one after the other.
double exact_tail(std::size_t n, std::size_t m, std::size_t u) {
  const std::size_t most = n * m;
  std::vector<std::vector<double>> ways(m + 1, std::vector<double>(most + 1, 0));
  ways[0][0] = 1;
  for (std::size_t j = 1; j <= m; ++j) ways[j][0] = 1;  // no times of a
  for (std::size_t i = 1; i <= n; ++i)
    for (std::size_t j = 1; j <= m; ++j)  // the largest is of b, above i times of a, or of a
      for (std::size_t v = most + 1; v-- > 0;) ways[j][v] += v >= i ? ways[j - 1][v - i] : 0;
  const std::vector<double>& counts = ways[m];
  const double all = std::accumulate(counts.begin(), counts.end(), 0.0);
  return std::accumulate(counts.begin() + static_cast<std::ptrdiff_t>(std::min(u, most + 1)), counts.end(), 0.0) / all;
}

double normal_tail(double z) { return 0.5 * std::erfc(z / std::numbers::sqrt2); }

double variance(double n, double m) { return n * m * (n + m + 1) / 12; }

double tail(std::size_t n, std::size_t m, double u) {
  if (std::max(n, m) <= most_exact) return exact_tail(n, m, static_cast<std::size_t>(u));
  const auto a = static_cast<double>(n), b = static_cast<double>(m);
  return normal_tail((u - 0.5 - a * b / 2) / std::sqrt(variance(a, b)));
}

double median_ratio(std::span<const double> a, std::span<const double> b) {
  std::vector<double> ratios;
  for (const double x : a)
    for (const double y : b) ratios.push_back(y / x);
  return quantile(std::move(ratios), 0.5);
}

}  // namespace

double quantile(std::vector<double> numbers, double share) {
  std::ranges::sort(numbers);
  const double position = share * static_cast<double>(numbers.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const auto above = std::min(below + 1, numbers.size() - 1);
  return std::lerp(numbers[below], numbers[above], position - static_cast<double>(below));
}

double exponent(double x0, double y0, double x1, double y1) { return std::log(y0 / y1) / std::log(x0 / x1); }

double exponent(std::span<const double> x, std::span<const double> y) {
  const auto n = static_cast<double>(x.size());
  double sum_p = 0, sum_q = 0, pp = 0, pq = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double p = std::log(x[k]), q = std::log(y[k]);
    sum_p += p, sum_q += q, pp += p * p, pq += p * q;
  }
  return (n * pq - sum_p * sum_q) / (n * pp - sum_p * sum_p);
}

double geometric_mean(std::span<const double> numbers) {
  double sum = 0;
  for (const double number : numbers) sum += std::log(number);
  return std::exp(sum / static_cast<double>(numbers.size()));
}

RankTest rank_test(std::span<const double> a, std::span<const double> b) {
  if (a.empty() || b.empty()) throw std::invalid_argument("a rank test needs samples");
  const double u = rank_statistic(a, b), pairs = static_cast<double>(a.size() * b.size());
  return {.slower = tail(a.size(), b.size(), u),
          .faster = tail(b.size(), a.size(), pairs - u),
          .superiority = u / pairs,
          .ratio = median_ratio(a, b)};
}

double slower_together(std::span<const Samples> pairs) {
  double sum = 0, square = 0;
  for (const auto& [a, b] : pairs) {
    const auto n = static_cast<double>(a.size()), m = static_cast<double>(b.size());
    const double weight = 1 / (n + m + 1);
    sum += weight * (rank_statistic(a, b) - n * m / 2);
    square += weight * weight * variance(n, m);
  }
  return square > 0 ? normal_tail(sum / std::sqrt(square)) : 1;
}

std::vector<bool> holm(std::span<const double> probabilities, double level) {
  std::vector<std::size_t> order(probabilities.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](std::size_t k) { return probabilities[k]; });
  std::vector<bool> significant(probabilities.size(), false);
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    if (!(probabilities[order[rank]] <= level / static_cast<double>(order.size() - rank))) break;
    significant[order[rank]] = true;
  }
  return significant;
}

}  // namespace drape::base
