#include "solver/stage/error_estimate.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace drape::solver {
namespace {

constexpr double mean_weight = 0.2;       ///< factor of the second estimate
constexpr double reduction_memory = 0.5;  ///< the least reduction to be expected, over the one observed before
constexpr double regular = 0.3;           ///< reduction above which convergence is too irregular to rely on
constexpr double reduction_ages = 1.3;    ///< factor of the expected reduction in each further stage
constexpr double sudden = 1.2;            ///< growth of the first |d| from stage to stage above which no reduction is expected

}  // namespace

ErrorEstimate::ErrorEstimate(const SplitOde& ode)
    : all_(*ode.partition),
      mass_(thrice(ode.mass)),
      drag_(ode.damping.nonZeros() > 0 ? thrice(ode.damping.diagonal()) : Eigen::VectorXd::Zero(mass_.size())),
      inverse_mass_(mass_.inverse()) {}

void ErrorEstimate::reset() { reduction_ = 1; }

void ErrorEstimate::next_stage() { reduction_ = std::min(1.0, reduction_ages * reduction_); }

void ErrorEstimate::measure(const Vectors& residual, double gamma) {
  if (gamma_ != gamma) {
    gamma_ = gamma;
    mass_scaling_ = (mass_ - gamma * drag_).inverse();
  }
  const double *const r = residual.data(), *const m = inverse_mass_.data(), *const u = mass_scaling_.data();
  const Partition::Range own = all_.own(residual.size());
  double plain = 0, by_mass = 0, scaled = 0;
#pragma omp simd reduction(+ : plain, by_mass, scaled)
  for (Eigen::Index i = own.begin; i < own.begin + own.count; ++i) {
    plain += r[i] * r[i];
    by_mass += (m[i] * r[i]) * (m[i] * r[i]);
    scaled += (u[i] * r[i]) * (u[i] * r[i]);
  }
  std::array sums{plain, by_mass, scaled};
  all_.add_up(sums);
  residual_ = std::sqrt(sums[0]);
  bound_ = std::sqrt(sums[1]);
  mass_scaled_ = std::sqrt(sums[2]);
}

void ErrorEstimate::observe_update(double size) {
  if (std::isfinite(last_)) {
    const double reduced = size / last_;
    reduction_ = reduced > regular ? 1 : std::max(reduced, reduction_memory * reduction_);
  } else {
    if (size > sudden * first_) reduction_ = 1;
    first_ = size;
  }
  last_ = size;
}

double ErrorEstimate::error(double size, double smallest_response) const {
  return reduction_ * std::max(size / smallest_response, mean_weight * std::sqrt(bound_ * size));
}

}  // namespace drape::solver
