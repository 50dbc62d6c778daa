#include "solver/filter.hpp"

namespace drape::solver {

Filter Filter::partial(const std::vector<Pin>& pins) {
  Filter filter;
  for (const Pin& pin : pins)
    if (!pin.all()) filter.add(pin.particle, pin.free());
  return filter;
}

void Filter::operator()(Vectors& r) const {
  for (const Block& block : blocks_) r.row(block.particle) *= block.free;
  if (projector_ != nullptr) projector_->project(r);
}

ObliquePins::ObliquePins(const std::vector<Pin>& pins) {
  for (const Pin& pin : pins)
    if (pin.oblique()) free_[pin.particle] = pin.free();
}

Eigen::Vector3d ObliquePins::filtered(int i, const Eigen::Vector3d& a) const {
  const auto found = free_.find(i);
  return found == free_.end() ? a : found->second * a;
}

Eigen::Matrix3d ObliquePins::filtered(int i, int j, const Eigen::Matrix3d& block) const {
  const auto of_i = free_.find(i), of_j = free_.find(j);
  Eigen::Matrix3d result = block;
  if (of_i != free_.end()) result = (of_i->second * result).eval();
  if (of_j != free_.end()) result *= of_j->second;
  return result;
}

void ObliquePins::operator()(Vectors& r) const {
  for (const auto& [i, free] : free_) r.row(i) *= free;
}

SparseMatrix ObliquePins::matrix(int particles) const {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < particles; ++i) {
    const auto found = free_.find(i);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        if (found != free_.end() || a == b)
          entries.emplace_back(3 * i + a, 3 * i + b, found == free_.end() ? 1 : found->second(a, b));
  }
  SparseMatrix P(3 * particles, 3 * particles);
  P.setFromTriplets(entries.begin(), entries.end());
  return P;
}

std::vector<Eigen::Matrix3d> allowed_directions(const SplitOde& ode) {
  std::vector<Eigen::Matrix3d> allowed;
  if (ode.pins.empty()) return allowed;
  allowed.assign(ode.particles(), Eigen::Matrix3d::Identity());
  for (const Pin& pin : ode.pins) allowed[pin.particle] = pin.free();
  return allowed;
}

}  // namespace drape::solver
