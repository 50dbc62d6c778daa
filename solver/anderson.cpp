#include "solver/anderson.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drape::solver {
namespace {

/// Part of the diagonal that is added to the normal equations: below it differences are parallel.
constexpr double ridge = 1e-13;

/// What counts as the response to a change before any was seen.
constexpr double unknown_response = 0.05;

}  // namespace

Anderson::Anderson(Eigen::Index particles)
    : v_(3 * particles), d_(3 * particles), dd_(3 * particles, depth), dg_(3 * particles, depth) {}

/// The differences from the last iterate to this one take the place of the oldest.
void Anderson::remember(const Eigen::Ref<const Eigen::VectorXd>& v, const Eigen::Ref<const Eigen::VectorXd>& d) {
  const int slot = (count_ - 2) % depth, count = kept();
  dd_.col(slot) = d - d_;
  dg_.col(slot) = dd_.col(slot) + (v - v_);
  lengths_[slot] = (v - v_).norm();
  gram_.col(slot).head(count).noalias() = dd_.leftCols(count).transpose() * dd_.col(slot);
  gram_.row(slot).head(count) = gram_.col(slot).head(count).transpose();
}

double Anderson::weakest() const {
  if (kept() < 1) return unknown_response;
  double weakest = 1;
  for (int i = 0; i < kept(); ++i) weakest = std::min(weakest, std::sqrt(gram_(i, i)) / lengths_[i]);
  return weakest;
}

/// Those of the normal equations of min |d − Σ w_i Δd_i|, with columns of length one.
Anderson::Small Anderson::weights() const {
  const int count = kept();
  const Small scale = gram_.diagonal().head(count).cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().cwiseInverse();
  Gram normal = Gram::Identity();
  normal.topLeftCorner(count, count) = scale.asDiagonal() * gram_.topLeftCorner(count, count) * scale.asDiagonal();
  normal.diagonal().array() += ridge;
  Eigen::Matrix<double, depth, 1> right = Eigen::Matrix<double, depth, 1>::Zero();
  right.head(count) = scale.cwiseProduct(projections_.head(count));
  return scale.cwiseProduct(normal.ldlt().solve(right).head(count));
}

void Anderson::advance(Vectors& v, Vectors& d) {
  Eigen::Map<Eigen::VectorXd> flat_v(v.data(), v.size()), flat_d(d.data(), d.size());
  ++count_;
  if (count_ > 1) remember(flat_v, flat_d);
  v_ = flat_v;
  d_ = flat_d;
  if (const int count = kept(); count > 0) {
    projections_.head(count).noalias() = dd_.leftCols(count).transpose() * d_;
    flat_d.noalias() -= dg_.leftCols(count) * weights();
  }
  v += d;
}

}  // namespace drape::solver
