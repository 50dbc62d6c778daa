#include "solver/anderson.hpp"

#include <algorithm>
#include <cmath>

namespace drape::solver {
namespace {

/// Part of the diagonal that is added to the normal equations: below it differences are parallel.
constexpr double ridge = 1e-13;

double dot(const Vectors& a, const Vectors& b) { return a.cwiseProduct(b).sum(); }

}  // namespace

Anderson::Anderson(Eigen::Index particles) {
  for (Vectors* field : {&v_, &d_}) field->setZero(particles, 3);
  for (auto* fields : {&dv_, &dd_})
    for (Vectors& field : *fields) field.setZero(particles, 3);
}

void Anderson::remember(const Vectors& v, const Vectors& d) {
  const int slot = (count_ - 1) % depth, kept = std::min(count_, depth);
  dv_[slot] = v - v_;
  dd_[slot] = d - d_;
  length_[slot] = dv_[slot].norm();
  for (int i = 0; i < kept; ++i) gram_(i, slot) = gram_(slot, i) = dot(dd_[i], dd_[slot]);
}

double Anderson::weakest() const {
  const int kept = std::min(count_ - 1, depth);
  constexpr double unknown = 0.05;
  double w = 1;
  for (int i = 0; i < kept; ++i) w = std::min(w, std::sqrt(gram_(i, i)) / length_[i]);
  return kept == 0 ? unknown : w;
}

void Anderson::advance(Vectors& v, Vectors& d) {
  if (count_ > 0) remember(v, d);
  v_ = v;
  d_ = d;
  const int kept = std::min(count_, depth);
  ++count_;
  if (kept > 0) {
    Eigen::VectorXd projections(kept);
    for (int i = 0; i < kept; ++i) projections[i] = dot(dd_[i], d_);
    Eigen::MatrixXd normal = gram_.topLeftCorner(kept, kept);
    const Eigen::VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    normal = scale.asDiagonal() * normal * scale.asDiagonal();
    normal.diagonal().array() += ridge;
    const Eigen::VectorXd weights = scale.cwiseProduct(normal.ldlt().solve(scale.cwiseProduct(projections)));
    for (int i = 0; i < kept; ++i) d -= weights[i] * (dv_[i] + dd_[i]);
  }
  v += d;
}

}  // namespace drape::solver
