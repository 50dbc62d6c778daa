#include "model/forces/linear_operator.hpp"

#include <tuple>

#include "model/forces/stencil_matrix.hpp"
#include "model/sheet/normals.hpp"
#include "solver/base/threads.hpp"

namespace drape::model {
namespace {

/// B x + B_d v.
struct Evaluator {
  LinearOperators operators;
  StencilMatrix elastic, viscous;

  explicit Evaluator(LinearOperators given)
      : operators(std::move(given)), elastic(operators.elastic), viscous(operators.viscous) {}

  /// The part of particle i; the fourth lane means nothing.
  solver::Lanes lanes_at(int i, const Configuration& c) const {
    const solver::Lanes q = elastic.times(i, c.x);
    return viscous.empty() ? q : q + viscous.times(i, c.v);
  }
  Eigen::Vector3d at(int i, const Configuration& c) const { return lanes_at(i, c).head<3>(); }

  /// Calls add(i, lanes_at(i)) for each particle; several threads do at the same time.
  template <class Add>
  void each(const Configuration& c, const Add& add) const {
    base::each_in_parts(base::threads_for(c.x.rows()), c.x.rows(), [&](std::int64_t k) {
      const int i = static_cast<int>(k);
      add(i, lanes_at(i, c));
    });
  }
};

/// Calls add(i, j, value) for the entries of B.
template <class Add>
void for_each(const SparseMatrix& B, const Add& add) {
  for (int i = 0; i < B.outerSize(); ++i)
    for (SparseMatrix::InnerIterator b(B, i); b; ++b) add(i, static_cast<int>(b.col()), b.value());
}

/// <B x, N> of all particles; zero of a flat sheet.
Eigen::VectorXd normal_part(const Grid& grid, const SparseMatrix& B, const Vectors& x) {
  if (x.size() == 0) return Eigen::VectorXd::Zero(B.rows());
  Vectors normals(x.rows(), 3);
  Normals(grid).evaluate(x, normals);
  return (B * x).cwiseProduct(normals).rowwise().sum();
}

/// B if it is symmetric; else its springs only: membranes are not symmetric on borders.
SparseMatrix symmetric_part(const SparseMatrix& B) {
  if (B.isApprox(SparseMatrix(B.transpose()))) return B;
  std::vector<Eigen::Triplet<double>> springs;
  for_each(B, [&](int i, int j, double b) {
    if (i == j || b < 0) return;
    for (const auto& [row, column, sign] : {std::tuple{i, j, 1}, {j, i, 1}, {i, i, -1}, {j, j, -1}})
      springs.emplace_back(row, column, 0.5 * sign * b);
  });
  SparseMatrix part(B.rows(), B.cols());
  part.setFromTriplets(springs.begin(), springs.end());
  return part;
}

}  // namespace

void add_quadratic(std::vector<Eigen::Triplet<double>>& entries, std::span<const StencilEntry> stencil, double weight) {
  if (weight == 0) return;
  for (const auto& [i, c] : stencil)
    for (const auto& [j, d] : stencil)
      if (c * d != 0) entries.emplace_back(i, j, -weight * c * d);
}

Term unprojected(LinearOperators operators) {
  const auto evaluate = std::make_shared<Evaluator>(std::move(operators));
  Term term;
  term.force = [evaluate](const Configuration& c, Vectors& f) {
    evaluate->each(c, [&](int i, const solver::Lanes& q) { f.row(i).array() += q.head<3>().transpose(); });
  };
  term.energy = [evaluate](const Vectors& x) {
    Vectors q(x.rows(), 3);
    evaluate->elastic.multiply(x, q);
    return -0.5 * x.cwiseProduct(q).sum();
  };
  term.jacobian = [evaluate](const Configuration&, const JacobianEntries& entries) {
    if (entries.curvature == Curvature::tension) return;
    const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
    for_each(evaluate->operators.elastic, [&](int i, int j, double b) { entries.add_dx(i, j, b * I); });
    for_each(evaluate->operators.viscous, [&](int i, int j, double b) { entries.add_dv(i, j, b * I); });
  };
  return term;
}

Term projected(const Grid& grid, LinearOperators operators, const Vectors& rest) {
  const auto evaluate = std::make_shared<Evaluator>(std::move(operators));
  const Eigen::VectorXd at_rest = normal_part(grid, evaluate->operators.elastic, rest);
  Term term;
  term.needs_normals = true;
  term.force = [evaluate, at_rest](const Configuration& c, Vectors& f) {
    evaluate->each(c, [&](int i, const solver::Lanes& q) {
      const Eigen::Array3d N = c.normals.row(i);
      f.row(i).array() += ((N * q.head<3>()).sum() - at_rest[i]) * N.transpose();
    });
  };
  term.active = true;
  term.without_energy = evaluate->operators.elastic.nonZeros() > 0;
  const LinearOperators convex{symmetric_part(evaluate->operators.elastic), symmetric_part(evaluate->operators.viscous)};
  term.jacobian = [evaluate, at_rest, convex, normals = Normals(grid)](const Configuration& c, const JacobianEntries& entries) {
    if (!entries.exact()) {
      if (entries.curvature == Curvature::tension) return;
      const auto NN = [&](int i, int j) -> Eigen::Matrix3d { return c.normals.row(i).transpose() * c.normals.row(j); };
      for_each(convex.elastic, [&](int i, int j, double b) { entries.add_dx(i, j, b * NN(i, j)); });
      for_each(convex.viscous, [&](int i, int j, double b) { entries.add_dv(i, j, b * NN(i, j)); });
      return;
    }
    const auto NN = [&](int i) -> Eigen::Matrix3d { return c.normals.row(i).transpose() * c.normals.row(i); };
    for_each(evaluate->operators.elastic, [&](int i, int j, double b) { entries.add_dx(i, j, b * NN(i)); });
    for_each(evaluate->operators.viscous, [&](int i, int j, double b) { entries.add_dv(i, j, b * NN(i)); });
    for (int i = 0; i < c.x.rows(); ++i) {
      const Eigen::Matrix3d by_N =
          projection_by_normal(evaluate->at(i, c), c.normals.row(i)) - at_rest[i] * Eigen::Matrix3d::Identity();
      for (const auto& [j, dN] : normals.derivative(c.x, i)) entries.add_dx(i, j, by_N * dN);
    }
  };
  return term;
}

}  // namespace drape::model
