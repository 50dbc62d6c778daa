#include "model/linear_operator.hpp"

#include "model/normals.hpp"
#include "solver/kernels.hpp"

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

}  // namespace

void add_quadratic(std::vector<Eigen::Triplet<double>>& entries, Stencil stencil, double weight) {
  if (weight == 0) return;
  for (const auto& [i, c] : stencil)
    for (const auto& [j, d] : stencil) entries.emplace_back(i, j, -weight * c * d);
}

Term unprojected(LinearOperators operators) {
  const auto evaluate = std::make_shared<Evaluator>(std::move(operators));
  Term term;
  term.force = [evaluate](const Configuration& c, Vectors& f) { f += (*evaluate)(c); };
  term.explicit_force = term.force;
  term.energy = [evaluate](const Vectors& x) {
    solver::multiply(evaluate->operators.elastic, x, evaluate->q);
    return -0.5 * x.cwiseProduct(evaluate->q).sum();
  };
  term.jacobian = [evaluate](const Configuration&, JacobianEntries& entries) {
    const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
    for_each(evaluate->operators.elastic, [&](int i, int j, double b) { entries.add_dx(i, j, b * I); });
    for_each(evaluate->operators.viscous, [&](int i, int j, double b) { entries.add_dv(i, j, b * I); });
  };
  return term;
}

Term projected(const Grid& grid, LinearOperators operators) {
  const auto evaluate = std::make_shared<Evaluator>(std::move(operators));
  Term term;
  term.needs_normals = true;
  term.force = [evaluate](const Configuration& c, Vectors& f) {
    const Vectors& q = (*evaluate)(c);
    for (Eigen::Index i = 0; i < q.rows(); ++i) f.row(i) += c.normals.row(i).dot(q.row(i)) * c.normals.row(i);
  };
  term.explicit_force = term.force;
  term.jacobian = [evaluate, normals = Normals(grid)](const Configuration& c, JacobianEntries& entries) {
    const auto NN = [&](int i) -> Eigen::Matrix3d { return c.normals.row(i).transpose() * c.normals.row(i); };
    for_each(evaluate->operators.elastic, [&](int i, int j, double b) { entries.add_dx(i, j, b * NN(i)); });
    for_each(evaluate->operators.viscous, [&](int i, int j, double b) { entries.add_dv(i, j, b * NN(i)); });
    const Vectors& q = (*evaluate)(c);
    for (int i = 0; i < q.rows(); ++i) {
      const Eigen::Matrix3d by_N = projection_by_normal(q.row(i), c.normals.row(i));
      for (const auto& [j, dN] : normals.derivative(c.x, i)) entries.add_dx(i, j, by_N * dN);
    }
  };
  return term;
}

}  // namespace drape::model
