#include "model/forces/linear_operator.hpp"

#include <tuple>

#include "model/forces/term.hpp"
#include "model/sheet/normals.hpp"
#include "solver/linear/kernels.hpp"

namespace drape::model {
namespace {

/// B x + B_d v with its scratch memory.
struct Evaluator {
  LinearOperators operators;
  Vectors q, viscous;

  explicit Evaluator(LinearOperators given) : operators(std::move(given)) {
    for (Vectors* field : {&q, &viscous}) field->setZero(operators.elastic.rows(), 3);
  }

  const Vectors& operator()(const Configuration& c) {
    solver::multiply(operators.elastic, c.x, q);
    if (operators.viscous.nonZeros() > 0) {
      solver::multiply(operators.viscous, c.v, viscous);
      q += viscous;
    }
    return q;
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
  term.force = [evaluate](const Configuration& c, Vectors& f) { f += (*evaluate)(c); };
  term.energy = [evaluate](const Vectors& x) {
    solver::multiply(evaluate->operators.elastic, x, evaluate->q);
    return -0.5 * x.cwiseProduct(evaluate->q).sum();
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
    const Vectors& q = (*evaluate)(c);
    for (Eigen::Index i = 0; i < q.rows(); ++i) f.row(i) += (c.normals.row(i).dot(q.row(i)) - at_rest[i]) * c.normals.row(i);
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
    const Vectors& q = (*evaluate)(c);
    for (int i = 0; i < q.rows(); ++i) {
      const Eigen::Matrix3d by_N = projection_by_normal(q.row(i), c.normals.row(i)) - at_rest[i] * Eigen::Matrix3d::Identity();
      for (const auto& [j, dN] : normals.derivative(c.x, i)) entries.add_dx(i, j, by_N * dN);
    }
  };
  return term;
}

}  // namespace drape::model
