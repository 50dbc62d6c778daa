#include "model/newton_matrix.hpp"

#include <algorithm>

namespace drape::model {
namespace {

/// Calls each(row, column, k) for the nine entries of a block.
template <class Each>
void for_entries(int i, int j, const Each& each) {
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) each(3 * i + a, 3 * j + b, 3 * a + b);
}

}  // namespace

NewtonMatrix::NewtonMatrix(Curvature curvature, const Eigen::VectorXd& mass, const std::vector<solver::Pin>& pins)
    : curvature_(curvature), mass_(mass.replicate(1, 3).reshaped<Eigen::RowMajor>()), pinned_(mass_.size(), false) {
  for (const solver::Pin& pin : pins)
    for (int a = 0; a < 3; ++a) pinned_[3 * pin.particle + a] = pin.fixed[a];
}

void NewtonMatrix::analyse(const Visit& visit) {
  std::vector<Eigen::Vector2i> dx, dv;
  visit({curvature_, [&](int i, int j, const Eigen::Matrix3d&) { dx.emplace_back(i, j); },
         [&](int i, int j, const Eigen::Matrix3d&) { dv.emplace_back(i, j); }});
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < mass_.size(); ++i) entries.emplace_back(i, i, 1);
  for (const auto* blocks : {&dx, &dv})
    for (const Eigen::Vector2i& block : *blocks)
      for_entries(block[0], block[1], [&](int row, int column, int) {
        if (kept(row, column)) entries.emplace_back(row, column, 1);
      });
  pattern_.resize(mass_.size(), mass_.size());
  pattern_.setFromTriplets(entries.begin(), entries.end());
  diagonal_.assign(pattern_.outerIndexPtr(), pattern_.outerIndexPtr() + mass_.size());  // the first of each row
  dx_ = slots(dx);
  dv_ = slots(dv);
}

NewtonMatrix::Slots NewtonMatrix::slots(const std::vector<Eigen::Vector2i>& blocks) const {
  Slots found;
  found.reserve(9 * blocks.size());
  for (const Eigen::Vector2i& block : blocks)
    for_entries(block[0], block[1], [&](int row, int column, int) {
      const int* const begin = pattern_.innerIndexPtr() + pattern_.outerIndexPtr()[row];
      const int* const end = pattern_.innerIndexPtr() + pattern_.outerIndexPtr()[row + 1];
      found.push_back(kept(row, column) ? static_cast<int>(std::lower_bound(begin, end, column) - pattern_.innerIndexPtr())
                                        : -1);
    });
  return found;
}

void NewtonMatrix::assemble(const Visit& visit, double gamma, SparseMatrix& J) {
  if (pattern_.size() == 0) analyse(visit);
  if (J.nonZeros() != pattern_.nonZeros()) J = pattern_;
  double* const values = J.valuePtr();
  std::fill_n(values, J.nonZeros(), 0.0);
  for (int i = 0; i < mass_.size(); ++i) values[diagonal_[i]] = mass_[i];
  const auto adder = [values](const Slots& slots, double weight) -> JacobianEntries::Add {
    return [values, weight, slot = slots.data()](int, int, const Eigen::Matrix3d& block) mutable {
      for_entries(0, 0, [&](int a, int b, int k) {
        if (slot[k] >= 0) values[slot[k]] -= weight * block(a, b);
      });
      slot += 9;
    };
  };
  visit({curvature_, adder(dx_, gamma * gamma), adder(dv_, gamma)});
}

}  // namespace drape::model
