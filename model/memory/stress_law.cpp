#include "model/memory/stress_law.hpp"

#include <algorithm>
#include <cmath>

namespace drape::model {
namespace {

/// Rate of a strain that stands still except for errors of solvers [1/s], of curvatures [1/ms].
constexpr double still = 1e-7;

constexpr double same_stress = 1e-6;  ///< relative difference from the limit that they explain as well

}  // namespace

Stress CurveLaw::stress(double strain, double, double z) const {
  const double s = sign(strain), size = s * strain, largest = std::max(z, size);
  return {s * curve_.stress(size, largest) - linear_ * strain, curve_.slope(size, largest) - linear_};
}

double CurveLaw::carry(double strain, double, double z) const { return std::max(z, sign(strain) * strain); }

double CurveLaw::rate(double strain, double strain_rate, double z) const {
  const double s = sign(strain);
  return s * strain < z ? 0 : std::max(0.0, s * strain_rate);
}

double CurveLaw::energy(double strain, double z) const {
  return curve_.recoverable(sign(strain) * strain, z) - 0.5 * linear_ * strain * strain;
}

double CurveLaw::branch_slope(double strain, double z) const {
  const double size = sign(strain) * strain;
  return curve_.branch_slope(size, std::max(z, size)) - linear_;
}

int CurveLaw::branch(double strain, double strain_rate, double z) const {
  const double s = sign(strain);
  return curve_.branch(s * strain, s * strain_rate > still, z);
}

double FrictionLaw::rate(double strain, double strain_rate, double z) const {
  return variable_slope(strain, strain_rate, z) * strain_rate;
}

Stress JenkinLaw::stress(double strain, double from, double z) const {
  const double slope = limit() / onset(), free = z + slope * (strain - from);
  return std::abs(free) < limit() ? Stress{free, slope} : Stress{std::copysign(limit(), free), 0};
}

double JenkinLaw::variable_slope(double, double strain_rate, double z) const {
  return std::abs(z) >= limit() && z * strain_rate > 0 ? 0 : limit() / onset();
}

/// Slides to either side, or sticks.
int JenkinLaw::branch(double, double strain_rate, double z) const {
  const bool slides = std::abs(z) >= limit() * (1 - same_stress) && std::copysign(strain_rate, z * strain_rate) > still;
  return !slides ? 0 : z < 0 ? -1 : 1;
}

double JenkinLaw::energy(double, double z) const { return 0.5 * z * z * onset() / limit(); }

Stress DahlLaw::stress(double strain, double from, double z) const {
  const double s = strain < from ? -1 : 1, left = (z - s * limit()) * std::exp(-s * (strain - from) / onset());
  return {s * limit() + left, -s * left / onset()};
}

double DahlLaw::variable_slope(double, double strain_rate, double z) const {
  return (limit() - (strain_rate < 0 ? -z : z)) / onset();
}

int DahlLaw::branch(double, double strain_rate, double) const { return strain_rate < -still ? -1 : 1; }

/// ∫ F dε on the way to no stress.
double DahlLaw::energy(double, double z) const {
  const double part = std::abs(z) / limit();
  return limit() * onset() * (part - std::log1p(part));
}

}  // namespace drape::model
