#pragma once

#include <span>
#include <vector>

namespace drape::base {

/// The number below which a share of the numbers is: 0 least, 0.5 median, 1 largest; interpolated between two. At least one.
double quantile(std::vector<double> numbers, double share);

/// p in y ~ x^p from one point to the next.
double exponent(double x0, double y0, double x1, double y1);

/// The same through all points, by least squares on logarithms. At least two points with different x.
double exponent(std::span<const double> x, std::span<const double> y);

/// NaN of nothing.
double geometric_mean(std::span<const double> numbers);

/// Two samples of times by their ranks: nothing is assumed of how times are distributed   [Mann, Whitney 1947].
struct RankTest {
  double slower = 1;       ///< probability that samples of one distribution look at least as much as if b took longer
  double faster = 1;       ///< the same for a
  double superiority = 0;  ///< Â₁₂: probability that a time of b exceeds one of a; ½: no difference   [Vargha, Delaney 2000]
  double ratio = 1;        ///< median of all b/a   [Hodges, Lehmann 1963, of logarithms]
};

/// Exact up to 30 samples each, where ties count for no difference; beyond, by the normal distribution. Throws
/// std::invalid_argument if a sample is empty.
RankTest rank_test(std::span<const double> a, std::span<const double> b);

/// A pair of samples; pairs are tested together.
struct Samples {
  std::vector<double> a, b;
};

/// The same probability `slower` for all pairs at once, for a difference that they share: the weighted sum of their rank
/// statistics against the normal distribution   [van Elteren 1960].
double slower_together(std::span<const Samples> pairs);

/// Which of several probabilities are significant so that the probability of any false alarm is at most `level`
/// [Holm 1979].
std::vector<bool> holm(std::span<const double> probabilities, double level);

}  // namespace drape::base
