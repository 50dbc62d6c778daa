#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>

#include "bench/runs/run.hpp"
#include "bench/studies/claims/claim.hpp"
#include "bench/studies/cross_checked_reference.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/theory/condition.hpp"
#include "solver/base/decompositions.hpp"
#include "solver/base/statistics.hpp"
#include "solver/linear/conjugate_gradients.hpp"
#include "solver/linear/kernels.hpp"
#include "solver/stability.hpp"

/// Claims about the linear systems of a step and the matrices in them.
namespace drape::bench {
namespace {

using solver::SparseMatrix;
using solver::Vectors;

constexpr double usual_step = 0.01;  ///< [s]

CompiledScene sheet_with(const std::string& scene, std::vector<model::Override> overrides) {
  const model::Scene loaded = model::load_scene(scene, overrides);
  return {loaded, model::compile(loaded)};
}

/// The sheet of table 3.2 hung by its edge, with n × n particles a spring length of 0.8/19 m apart.
CompiledScene hung_edge(int n, double damping) {
  return sheet_with("hung-edge", {{"grid.n", fmt::format("{}", n)},
                                  {"grid.size", fmt::format("{}", 0.8 / 19 * (n - 1))},
                                  {"material.damping", fmt::format("{}", damping)}});
}

std::vector<bool> pinned_particles(const solver::SplitOde& ode) {
  std::vector<bool> pinned(static_cast<std::size_t>(ode.particles()), false);
  for (const solver::Pin& pin : ode.pins) pinned[static_cast<std::size_t>(pin.particle)] = true;
  return pinned;
}

/// M^−½ A M^−½ of the free particles, dense.
Eigen::MatrixXd scaled_matrix(const CompiledScene& sheet, double gamma) {
  const solver::SplitOde& ode = sheet.cloth.ode;
  const std::vector<bool> pinned = pinned_particles(ode);
  std::vector<int> kept;
  for (int i = 0; i < ode.particles(); ++i)
    if (!pinned[static_cast<std::size_t>(i)]) kept.push_back(i);
  const Eigen::VectorXd root = ode.mass.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd A = root.asDiagonal() * Eigen::MatrixXd(reference::stage_matrix(ode, gamma)) * root.asDiagonal();
  return A(kept, kept);
}

double condition(const Eigen::MatrixXd& A) {
  const Eigen::VectorXd values = base::symmetric_eigen(A).values;
  return values[values.size() - 1] / values[0];
}

double g_of(const CompiledScene& sheet) {
  const double nu = model::numerical_stiffness(sheet.scene, usual_step);
  return nu * (1 + 1 / model::stiffness_to_damping(sheet.scene, usual_step));
}

constexpr double of_eigenvalues = 1e-8;  ///< relative uncertainty of κ

std::vector<ClaimCase> condition_follows_stiffness() {
  const CompiledScene one = hung_edge(20, 50);
  // Twice the length and the density, so that with 8 times the tension and damping ν_h and δ_h are the same.
  const CompiledScene other = sheet_with(
      "hung-edge", {{"grid.size", "1.6"}, {"material.density", "2"}, {"material.tension", "8e4"}, {"material.damping", "400"}});
  const double kappa = condition(scaled_matrix(one, usual_step));
  return {{"other k, d, ρ, l", condition(scaled_matrix(other, usual_step)) / kappa, of_eigenvalues, 0.999999, 1.000001},
          {"n = 10 instead of 20", condition(scaled_matrix(hung_edge(10, 50), usual_step)) / kappa, of_eigenvalues, 0.999999,
           1.000001}};
}

std::vector<ClaimCase> condition_is_as_in_closed_form() {
  std::vector<ClaimCase> cases;
  for (const auto& [n, damping] : {std::pair{20, 0.0}, std::pair{20, 50.0}, std::pair{10, 5.0}}) {
    const CompiledScene sheet = hung_edge(n, damping);
    cases.push_back({fmt::format("n = {}, d = {:g}", n, damping),
                     condition(scaled_matrix(sheet, usual_step)) /
                         reference::stage_eigenvalues(n, g_of(sheet), reference::PinnedBorder::one_edge).condition(),
                     of_eigenvalues, 0.999999, 1.000001});
  }
  return cases;
}

constexpr double reduction = 2e-4;  ///< ε of (3.7), the program's usual tolerance

/// Iterations of conjugate gradients until the A-norm of the error has fallen by `reduction`.
int iterations_in_energy_norm(const Eigen::MatrixXd& A, const Eigen::VectorXd& solution) {
  const SparseMatrix sparse = A.sparseView();
  const auto none = solver::make_unpreconditioned();
  none->analyse(sparse);
  Vectors one = Vectors::Zero(solution.size(), 3);
  one.col(0) = solution;
  return reference::krylov_run(sparse, *none, one, reduction).iterations;
}

Eigen::VectorXd random_numbers(Eigen::Index size) {
  std::mt19937_64 generator(1);  // NOLINT: the same at every run
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(size, [&](Eigen::Index) { return normal(generator); });
}

/// Iterations over the number of (3.7), ½ √κ ln(2/ε).
std::vector<ClaimCase> bound_suffices() {
  std::vector<ClaimCase> cases;
  for (const double damping : {0.0, 50.0}) {
    const Eigen::MatrixXd A = scaled_matrix(hung_edge(20, damping), usual_step);
    const double bound = reference::sufficient_iterations(condition(A), reduction);
    const Eigen::VectorXd any = random_numbers(A.rows()), fall = Eigen::VectorXd::Ones(A.rows());
    for (const auto& [name, solution] : {std::pair{"random", any}, std::pair{"as gravity", fall}})
      cases.push_back({fmt::format("d = {:g}, {} solution", damping, name), iterations_in_energy_norm(A, solution) / bound,
                       1 / bound, 0, 1});
  }
  return cases;
}

int iterations_with(std::unique_ptr<solver::Preconditioner> preconditioner, const SparseMatrix& A) {
  constexpr int most = 100'000;
  solver::Counters work;
  solver::ConjugateGradients cg(std::move(preconditioner), most, work);
  cg.analyse(A);
  if (cg.factor(A) != solver::Outcome::success) return most;
  Vectors r = Vectors::Zero(A.rows(), 3), d = r;
  for (int c = 0; c < 3; ++c) r.col(c) = random_numbers(A.rows());
  return cg.solve(A, {}, r, d, reduction * r.norm()).iterations;
}

std::vector<ClaimCase> incomplete_cholesky_saves_iterations() {
  std::vector<ClaimCase> cases;
  for (const int n : {10, 20, 40}) {
    const SparseMatrix A = reference::stage_matrix(hung_edge(n, 0).cloth.ode, usual_step);
    const double plain = iterations_with(solver::make_unpreconditioned(), A);
    cases.push_back(
        {fmt::format("n = {}", n), iterations_with(solver::make_incomplete_cholesky(), A) / plain, 1 / plain, 0, 1});
  }
  return cases;
}

/// Multiplications of IC(0)-CG over those of a product with the dense inverse, for three coordinates. An iteration passes over
/// A, over both triangles of its factor, and over five vectors.
std::vector<ClaimCase> iterating_beats_the_inverse() {
  constexpr double passes_over_vectors = 5;
  std::vector<ClaimCase> cases;
  for (const int n : {4, 8, 12, 20, 40}) {
    const SparseMatrix A = reference::stage_matrix(hung_edge(n, 50).cloth.ode, usual_step);
    const double N = n * n, entries = static_cast<double>(A.nonZeros());
    const double an_iteration = 3 * (2 * entries + N + passes_over_vectors * N);
    const double ratio = iterations_with(solver::make_incomplete_cholesky(), A) * an_iteration / (3 * N * N);
    cases.push_back({fmt::format("N = {}", n * n), ratio, an_iteration / (3 * N * N) / 2, 0, 1});
  }
  return cases;
}

/// Largest singular value, by power iteration.
double spectral_norm(const SparseMatrix& A) {
  constexpr int iterations = 300;
  Eigen::VectorXd x = random_numbers(A.cols()).normalized();
  double norm = 0;
  for (int k = 0; k < iterations; ++k) {
    const Eigen::VectorXd y = A.transpose() * (A * x);
    norm = y.norm();
    x = y / norm;
  }
  return std::sqrt(norm);
}

/// B in all three coordinates: 3N × 3N.
SparseMatrix in_three_coordinates(const SparseMatrix& B) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < B.outerSize(); ++k)
    for (SparseMatrix::InnerIterator b(B, k); b; ++b)
      for (int c = 0; c < 3; ++c) entries.emplace_back(3 * b.row() + c, 3 * b.col() + c, b.value());
  SparseMatrix all(3 * B.rows(), 3 * B.cols());
  all.setFromTriplets(entries.begin(), entries.end());
  return all;
}

struct WholeJacobian {
  SparseMatrix df_dx, df_dv;
};

WholeJacobian jacobian_at(const solver::SplitOde& ode, const solver::State& y) {
  WholeJacobian J;
  ode.jacobian(0, y.x, y.v, J.df_dx, J.df_dv);
  return J;
}

/// ‖∂f_expl/∂x‖/‖K‖ of springs alone.
double explicit_part(const CompiledScene& sheet, const solver::State& y) {
  const SparseMatrix K = in_three_coordinates(sheet.cloth.ode.stiffness);
  const SparseMatrix rest = jacobian_at(sheet.cloth.ode, y).df_dx - K;
  return spectral_norm(rest) / spectral_norm(K);
}

std::vector<ClaimCase> nonlinear_springs_do_not_matter() {
  constexpr double of_power_iteration = 1e-2, insignificant = 0.1;
  const CompiledScene sheet = sheet_with("hung-corners", {{"material.shear", "0"}, {"end.time", "0.2"}});
  const RunSpec spec{sheet.scene, "", &solver::method("midpoint"), usual_step, {}};
  const solver::State swung = run(spec, sheet.cloth).state;
  return {{"at the start", explicit_part(sheet, sheet.cloth.start), of_power_iteration, 0, insignificant},
          {"after 0.2 s", explicit_part(sheet, swung), of_power_iteration, 0, insignificant}};
}

/// Entries of K in three coordinates over those of the whole ∂f/∂x.
std::vector<ClaimCase> a_third_of_the_entries() {
  std::vector<ClaimCase> cases;
  const auto add = [&](const char* where, std::vector<model::Override> overrides) {
    const CompiledScene sheet = sheet_with("hung-corners", std::move(overrides));
    const double whole = static_cast<double>(jacobian_at(sheet.cloth.ode, sheet.cloth.start).df_dx.nonZeros());
    cases.push_back({where, 3 * static_cast<double>(sheet.cloth.ode.stiffness.nonZeros()) / whole, 0, 0.3, 0.37});
  };
  add("tension alone", {{"material.shear", "0"}});
  add("with shear", {});
  add("with shear and a plate", {{"material.bend", "1e-3"}, {"material.bend_form", "plate"}});
  return cases;
}

/// A matrix of 3N rows by rows of 3 × 3 blocks, which is how codes with the whole Jacobian multiply.
class BlockRows {
 public:
  explicit BlockRows(const SparseMatrix& matrix) : begins_(matrix.cols() / 3 + 1, 0) {
    std::map<std::pair<Eigen::Index, Eigen::Index>, Eigen::Matrix3d> blocks;
    for (Eigen::Index column = 0; column < matrix.outerSize(); ++column)
      for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry)
        blocks.try_emplace({entry.row() / 3, entry.col() / 3}, Eigen::Matrix3d::Zero())
            .first->second(entry.row() % 3, entry.col() % 3) = entry.value();
    for (const auto& [place, block] : blocks) {
      ++begins_[place.first + 1];
      columns_.push_back(static_cast<int>(place.second));
      blocks_.push_back(block);
    }
    std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
  }

  /// y ← matrix x; N × 3 each.
  void multiply(const Vectors& x, Vectors& y) const {
    for (std::size_t row = 0; row + 1 < begins_.size(); ++row) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int k = begins_[row]; k < begins_[row + 1]; ++k) sum.noalias() += blocks_[k] * x.row(columns_[k]).transpose();
      y.row(static_cast<Eigen::Index>(row)) = sum;
    }
  }

 private:
  std::vector<int> begins_, columns_;
  std::vector<Eigen::Matrix3d> blocks_;
};

/// Times of products of A with three coordinates over those of the whole ∂f/∂x with the same, both on one thread. Their ratio
/// is taken pair by pair, one after the other, so that what else runs meets both.
std::vector<ClaimCase> a_third_of_the_time() {
  constexpr int pairs = 41;
  std::vector<ClaimCase> cases;
  const auto add = [&](const char* where, std::vector<model::Override> overrides) {
    overrides.insert(overrides.end(), {{"grid.n", "60"}, {"material.damping", "0"}});
    const CompiledScene sheet = sheet_with("hung-corners", std::move(overrides));
    const SparseMatrix A = reference::stage_matrix(sheet.cloth.ode, usual_step);
    const BlockRows whole(jacobian_at(sheet.cloth.ode, sheet.cloth.start).df_dx);
    const Vectors x = sheet.cloth.start.x;
    Vectors y = x;
    const auto seconds = [](const auto& work) {
      const auto start = std::chrono::steady_clock::now();
      work();
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    std::vector<double> ratios;
    for (int k = 0; k < pairs; ++k) {
      const double constant = seconds([&] { solver::multiply(A, x, y); });
      ratios.push_back(constant / seconds([&] { whole.multiply(x, y); }));
    }
    const double quartiles = base::quantile(ratios, 0.75) - base::quantile(ratios, 0.25);
    cases.push_back({where, base::quantile(ratios, 0.5), quartiles / 2, 0, 0.37});
  };
  add("tension alone", {{"material.shear", "0"}});
  add("with shear", {});
  return cases;
}

/// Largest |K_ij|/k − 1 of couplings, and of masses over ρ l², in the interior or at all.
double deviation_from_unscaled(int n, bool interior) {
  const CompiledScene sheet = sheet_with("hung-edge", {{"grid.n", fmt::format("{}", n)}, {"grid.size", "1"}});
  const model::Grid& grid = sheet.scene.sheet.grid;
  const auto inside = [&](Eigen::Index i) {
    const auto a = i % grid.nu, b = i / grid.nu;
    return a > 0 && a < grid.nu - 1 && b > 0 && b < grid.nv - 1;
  };
  const double k = sheet.scene.sheet.material.tension.weft, area = std::pow(grid.spacing_u(), 2);
  double deviation = 0;
  const SparseMatrix& K = sheet.cloth.ode.stiffness;
  for (int row = 0; row < K.outerSize(); ++row)
    for (SparseMatrix::InnerIterator entry(K, row); entry; ++entry)
      if (entry.row() != entry.col() && (!interior || (inside(entry.row()) && inside(entry.col()))))
        deviation = std::max(deviation, std::abs(entry.value() / k - 1));
  for (Eigen::Index i = 0; i < K.rows(); ++i)
    if (!interior || inside(i))
      deviation = std::max(deviation, std::abs(sheet.cloth.ode.mass[i] / (sheet.scene.sheet.material.density * area) - 1));
  return deviation;
}

std::vector<ClaimCase> masses_alone_scale() {
  constexpr double round_off = 1e-13;
  std::vector<ClaimCase> cases;
  for (const auto& [where, interior] : {std::pair{"in the interior", true}, std::pair{"at borders", false}}) {
    double worst = 0;
    for (const int n : {5, 9, 17}) worst = std::max(worst, deviation_from_unscaled(n, interior));
    cases.push_back({where, worst, round_off, -10 * round_off, 10 * round_off});
  }
  return cases;
}

/// The limit of velocity Verlet over l/c, c = √(k/ρ).
std::vector<ClaimCase> courant_limit() {
  constexpr double safety = 0.011;  // by which the program underestimates the limit
  const auto limit = [](const CompiledScene& sheet) {
    const double l = sheet.scene.sheet.grid.spacing_u();
    const double c = std::sqrt(sheet.scene.sheet.material.tension.weft / sheet.scene.sheet.material.density);
    return solver::verlet_limit(solver::spectrum(sheet.cloth.ode, 0, sheet.cloth.start)) * c / l;
  };
  return {
      {"a chain", limit(sheet_with("chain", {{"material.damping", "0"}})), safety, 0.97, 1.03},
      {"a sheet", limit(sheet_with("hung-edge", {{"material.damping", "0"}, {"material.shear", "0"}})), safety, 0.97, 1.03}};
}

constexpr const char* thesis_with_systems = "Etzmuß 2002";

constexpr Claim of_systems[] = {
    {"C-01", thesis_with_systems, "3.1.2 (3.7)", "½ √κ ln(2/ε) iterations of CG suffice", "iterations over that number", "1",
     bound_suffices},
    {"C-02", thesis_with_systems, "3.4.2", "the condition of A depends on h²k/ρl² and hd/ρl² only",
     "κ over that of the same ν_h, δ_h", "1", condition_follows_stiffness},
    {"C-02b", thesis_with_systems, "3.4.2", "with an edge pinned κ is known in closed form", "κ over that", "1",
     condition_is_as_in_closed_form},
    {"C-03", thesis_with_systems, "3.4.2", "incomplete Cholesky saves iterations", "iterations over those without", "1",
     incomplete_cholesky_saves_iterations},
    {"C-06", thesis_with_systems, "3.3.3", "the Jacobian of the nonlinear part of springs is insignificant",
     "its norm over that of K", "1", nonlinear_springs_do_not_matter},
    {"C-12b", thesis_with_systems, "3.1.1", "explicit methods are stable up to h = l/c", "limit over l/c", "1", courant_limit},
    {"C-13", thesis_with_systems, "3.4.3", "A has a third of the entries of the whole Jacobian", "entries over entries", "1",
     a_third_of_the_entries},
    {"C-13b", thesis_with_systems, "3.4.3", "so that an iteration takes a third of the time",
     "time of a product with A over that with 3 × 3 blocks of ∂f/∂x", "1", a_third_of_the_time, "bench/run study claims", true},
    {"C-14", thesis_with_systems, "3.3.4", "CG is cheaper than a product with the dense inverse",
     "multiplications over those of it", "1", iterating_beats_the_inverse},
    {"C-19", thesis_with_systems, "2.3.4", "scaling masses by l² does what scaling springs by 1/l² does",
     "largest deviation of masses and couplings", "1", masses_alone_scale},
};

}  // namespace

std::span<const Claim> system_claims() { return of_systems; }

}  // namespace drape::bench
