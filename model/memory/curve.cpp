#include "model/memory/curve.hpp"

#include <algorithm>

namespace drape::model {
namespace {

/// Difference from the largest strain that errors of solvers may explain; and over it.
constexpr double same_strain = 1e-7;

}  // namespace

/// That before x ends the piece which holds x; the first and the last go on for ever.
std::size_t Polyline::piece(double x) const {
  const auto next = std::ranges::upper_bound(points_, x, {}, [](const Point& point) { return point[0]; });
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(next - points_.begin(), 1, std::ssize(points_) - 1)) - 1;
}

/// Slopes at inner points: the weighted harmonic mean of those of the pieces, 0 where these have different signs.
Polyline Polyline::smoothed() const {
  Polyline smooth = *this;
  if (points_.size() < 2) return smooth;
  const std::size_t last = points_.size() - 1;
  smooth.slopes_.assign(points_.size(), 0);
  smooth.slopes_.front() = chord(0);
  smooth.slopes_.back() = chord(last - 1);
  for (std::size_t k = 1; k < last; ++k) {
    const double before = chord(k - 1), after = chord(k), h0 = length(k - 1), h1 = length(k);
    if (before * after > 0) smooth.slopes_[k] = 3 * (h0 + h1) / ((2 * h1 + h0) / before + (h1 + 2 * h0) / after);
  }
  return smooth;
}

double Polyline::chord_slope(double x) const { return chord(piece(x)); }

// A cubic piece is y0 + l (m0 s + (3 c − 2 m0 − m1) s² + (m0 + m1 − 2 c) s³) with s from 0 to 1, the length l and the chord's
// slope c.

double Polyline::slope(double x) const {
  const std::size_t k = piece(x);
  const double c = chord(k);
  if (slopes_.empty()) return c;
  const double s = (x - points_[k][0]) / length(k);
  const double m0 = slopes_[k], m1 = slopes_[k + 1];
  if (s <= 0) return m0;
  return s >= 1 ? m1 : m0 + s * (2 * (3 * c - 2 * m0 - m1) + s * 3 * (m0 + m1 - 2 * c));
}

double Polyline::value(double x) const {
  const std::size_t k = piece(x);
  const double l = length(k), along = x - points_[k][0], c = chord(k);
  if (slopes_.empty()) return points_[k][1] + c * along;
  const double s = along / l, m0 = slopes_[k], m1 = slopes_[k + 1];
  if (s <= 0) return points_[k][1] + m0 * along;
  if (s >= 1) return points_[k + 1][1] + m1 * (along - l);
  return points_[k][1] + along * (m0 + s * (3 * c - 2 * m0 - m1 + s * (m0 + m1 - 2 * c)));
}

/// From the beginning of piece k, which holds x or is followed by it.
double Polyline::integral_of_piece(std::size_t k, double x) const {
  const double l = length(k), along = x - points_[k][0], s = along / l, c = chord(k);
  if (slopes_.empty() || s <= 0) return along * (points_[k][1] + 0.5 * (slopes_.empty() ? c : slopes_[k]) * along);
  const double m0 = slopes_[k], m1 = slopes_[k + 1];
  if (s > 1) return integral_of_piece(k, points_[k + 1][0]) + (along - l) * (points_[k + 1][1] + 0.5 * m1 * (along - l));
  return along * (points_[k][1] + along * (m0 / 2 + s * ((3 * c - 2 * m0 - m1) / 3 + s * (m0 + m1 - 2 * c) / 4)));
}

double Polyline::integral(double x) const {
  const std::size_t last = piece(x);
  double sum = integral_of_piece(last, x);
  for (std::size_t k = 0; k < last; ++k) sum += integral_of_piece(k, points_[k + 1][0]);
  return sum;
}

double StressCurve::stress(double strain, double largest) const {
  if (!unloads(strain, largest)) return loading.value(strain);
  return loading.value(largest) * std::max(0.0, unloading.value(strain / largest));
}

template <class Slope>
double StressCurve::slope_by(const Slope& slope_of, double strain, double largest) const {
  if (!unloads(strain, largest)) return slope_of(loading, strain);
  const double part = strain / largest;
  return part < unloading.points().front()[0] ? 0 : loading.value(largest) / largest * slope_of(unloading, part);
}

double StressCurve::slope(double strain, double largest) const {
  return slope_by([](const Polyline& of, double x) { return of.slope(x); }, strain, largest);
}

double StressCurve::branch_slope(double strain, double largest) const {
  return slope_by([](const Polyline& of, double x) { return of.chord_slope(x); }, strain, largest);
}

/// Pieces of the loading branch are 0, 1, …; those of the unloading branch −1, −2, …, the first up to the residual strain.
int StressCurve::branch(double strain, bool grows, double largest) const {
  const bool loads = strain >= largest - same_strain * (1 + largest) && grows;
  if (unloading.empty() || loads || largest <= 0 || strain < 0) return loading.straight_piece(strain);
  const double part = std::min(strain / largest, 1 - same_strain);
  return part < unloading.points().front()[0] ? -1 : -2 - unloading.straight_piece(part);
}

StressCurve StressCurve::smoothed() const { return {loading.smoothed(), unloading.smoothed()}; }

double StressCurve::recoverable(double strain, double largest) const {
  if (unloading.empty() || strain <= 0) return loading.integral(strain);
  const double most = std::max(strain, largest), part = std::max(strain / most, unloading.points().front()[0]);
  return loading.value(most) * most * unloading.integral(part);
}

}  // namespace drape::model
