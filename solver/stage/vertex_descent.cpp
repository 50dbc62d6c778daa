#include "solver/stage/vertex_descent.hpp"

#include <algorithm>
#include <stdexcept>

namespace drape::solver {
namespace {

constexpr double sweep_radius = 0.95;  ///< ρ as published   [Chen et al. 2024]
constexpr int sweep_delay = 0;         ///< sweeps before the first weight, besides the first sweep

/// For each particle those that act on it, from the pattern of the upper triangle of a Newton matrix.
std::vector<std::vector<int>> neighbours(const SparseMatrix& J) {
  std::vector<std::vector<int>> found(J.rows() / 3);
  for (int row = 0; row < J.rows(); ++row)
    for (SparseMatrix::InnerIterator entry(J, row); entry; ++entry) {
      const int i = row / 3, j = static_cast<int>(entry.col()) / 3;
      if (i == j) continue;
      found[i].push_back(j);
      found[j].push_back(i);
    }
  return found;
}

}  // namespace

VertexDescent::VertexDescent(const SplitOde& ode, const Options& options, StageSystem& system)
    : StageIteration(ode, options, system),
      blocks_(ode.particles()),
      iterates_(ode.particles(), sweep_radius, sweep_delay),
      last_(Vectors::Zero(ode.particles(), 3)) {
  if (!ode.newton_matrix) throw std::invalid_argument("stage solver 'vbd': expected an ODE with a newton_matrix");
}

void VertexDescent::begin(const State& y) { iterates_.restart(y.v); }

void VertexDescent::find_blocks(double inertia) {
  for (int i = 0; i < ode().particles(); ++i) {
    Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
    for (int a = 0; a < 3; ++a)
      for (SparseMatrix::InnerIterator entry(J_, 3 * i + a); entry && entry.col() < 3 * i + 3; ++entry)
        block(a, entry.col() - 3 * i) = block(entry.col() - 3 * i, a) = entry.value();
    block.diagonal().array() += (inertia - 1) * ode().mass[i];  // J_ has M, the stage μ M
    blocks_[i] = block.inverse();
  }
}

/// Gives every particle the first colour that none of its neighbours has.
void VertexDescent::find_colours() {
  const std::vector<std::vector<int>> near = neighbours(J_);
  std::vector<int> colour_of(near.size(), -1);
  for (int i = 0; i < static_cast<int>(near.size()); ++i) {
    int colour = 0;
    const auto taken = [&](int j) { return colour_of[j] == colour; };
    while (std::ranges::any_of(near[i], taken)) ++colour;
    colour_of[i] = colour;
    if (colour == static_cast<int>(colours_.size())) colours_.emplace_back();
    colours_[colour].push_back(i);
  }
}

void VertexDescent::move(const std::vector<int>& colour, Vectors& v) const {
  const Vectors& r = system().residual();
  for (const int i : colour) v.row(i) += r.row(i) * blocks_[i];  // symmetric
}

LinearResult VertexDescent::advance(const Stage& stage, State& y, double) {
  ode().newton_matrix(stage.t, y.x, y.v, stage.gamma, Jacobian::whole, J_);
  find_blocks(stage.inertia);
  if (colours_.empty()) find_colours();
  last_ = y.v;
  for (std::size_t k = 0; k < colours_.size(); ++k) {
    if (k > 0) evaluate(stage, y);
    move(colours_[k], y.v);
  }
  iterates_.combine(last_, y.v);
  evaluate(stage, y);
  return {};
}

}  // namespace drape::solver
