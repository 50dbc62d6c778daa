#include "model/memory/curve.hpp"

#include <algorithm>

namespace drape::model {

/// That before x ends the piece which holds x; the first and the last go on for ever.
std::size_t Polyline::piece(double x) const {
  const auto next = std::ranges::upper_bound(points_, x, {}, [](const Point& point) { return point[0]; });
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(next - points_.begin(), 1, std::ssize(points_) - 1)) - 1;
}

double Polyline::slope(double x) const {
  const std::size_t k = piece(x);
  return (points_[k + 1][1] - points_[k][1]) / (points_[k + 1][0] - points_[k][0]);
}

double Polyline::value(double x) const {
  const std::size_t k = piece(x);
  return points_[k][1] + slope(x) * (x - points_[k][0]);
}

double Polyline::integral(double x) const {
  const std::size_t last = piece(x);
  double sum = 0;
  for (std::size_t k = 0; k < last; ++k) sum += 0.5 * (points_[k][1] + points_[k + 1][1]) * (points_[k + 1][0] - points_[k][0]);
  return sum + 0.5 * (points_[last][1] + value(x)) * (x - points_[last][0]);
}

double StressCurve::stress(double strain, double largest) const {
  if (!unloads(strain, largest)) return loading.value(strain);
  return loading.value(largest) * std::max(0.0, unloading.value(strain / largest));
}

double StressCurve::slope(double strain, double largest) const {
  if (!unloads(strain, largest)) return loading.slope(strain);
  const double part = strain / largest;
  return part < unloading.points().front()[0] ? 0 : loading.value(largest) / largest * unloading.slope(part);
}

double StressCurve::recoverable(double strain, double largest) const {
  if (unloading.empty() || strain <= 0) return loading.integral(strain);
  const double most = std::max(strain, largest), part = std::max(strain / most, unloading.points().front()[0]);
  return loading.value(most) * most * unloading.integral(part);
}

}  // namespace drape::model
