#include "reference/reference.hpp"

#include <algorithm>
#include <cmath>

namespace drape::reference {

double rms_distance(const solver::Vectors& a, const solver::Vectors& b) {
  return std::sqrt((a - b).squaredNorm() / static_cast<double>(a.rows()));
}

Reference reference(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                    const CvodeOptions& options) {
  Reference result{"cvode-bdf", options.rtol, {}, cvode(ode, y0, t0, times, options)};
  CvodeOptions looser = options;
  looser.rtol *= 100;
  const auto distance = [](const solver::State& a, const solver::State& b) { return rms_distance(a.x, b.x); };
  std::ranges::transform(result.trajectory.states, cvode(ode, y0, t0, times, looser).states, std::back_inserter(result.error),
                         distance);
  return result;
}

}  // namespace drape::reference
