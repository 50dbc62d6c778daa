#include "verify/support/equilibrium.hpp"

#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

#include "solver/base/decompositions.hpp"

namespace drape::verify {

solver::Vectors equilibrium(const model::Scene& scene, solver::Vectors x) {
  const solver::SplitOde ode = model::compile(scene).ode;
  solver::Vectors free = solver::Vectors::Ones(x.rows(), 3);
  solver::filter(ode.pins, free);
  const auto is_free = free.reshaped<Eigen::RowMajor>();
  const solver::Vectors at_rest = 0 * x;
  solver::SparseMatrix df_dx, df_dv;
  std::function<Eigen::VectorXd(const Eigen::VectorXd&)> inverse;
  const auto correction = [&](const solver::Vectors& at) {
    solver::Vectors f(at.rows(), 3);
    ode.force(0, at, at_rest, f);
    const Eigen::VectorXd solved = inverse((f.array() * free.array()).matrix().reshaped<Eigen::RowMajor>().eval());
    return solver::Vectors(-solved.reshaped<Eigen::RowMajor>(x.rows(), 3));
  };
  for (int iteration = 0; iteration < 300; ++iteration) {
    ode.jacobian(0, x, at_rest, df_dx, df_dv);
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < df_dx.rows(); ++i) {
      if (is_free[i] == 0) entries.emplace_back(i, i, 1);
      for (solver::SparseMatrix::InnerIterator a(df_dx, i); a; ++a)
        if (is_free[i] != 0 && is_free[a.col()] != 0) entries.emplace_back(i, a.col(), a.value());
    }
    Eigen::SparseMatrix<double> jacobian(df_dx.rows(), df_dx.cols());
    jacobian.setFromTriplets(entries.begin(), entries.end());
    inverse = base::lu_inverse(jacobian);
    if (!inverse) break;
    const solver::Vectors step = correction(x);
    if (step.lpNorm<Eigen::Infinity>() <= 1e-10) return x + step;
    double part = 1;
    while (part > 1e-6 && !(correction(x + part * step).norm() < (1 - part / 4) * step.norm())) part /= 2;
    x += part * step;
  }
  throw std::runtime_error("Newton's method found no equilibrium of the scene.");
}

double rms_distance(const model::Grid& grid, const solver::Vectors& a, const solver::Vectors& b) {
  const Eigen::VectorXd areas = grid.cell_areas();
  return std::sqrt(areas.dot((a - b).rowwise().squaredNorm()) / areas.sum());
}

}  // namespace drape::verify
