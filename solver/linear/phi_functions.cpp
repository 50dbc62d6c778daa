#include "solver/linear/phi_functions.hpp"

#include <algorithm>
#include <cmath>

#include "solver/filter.hpp"
#include "solver/linear/kernels.hpp"

namespace drape::solver {
namespace {

/// What is left of a vector beside the space, over its size, when the space contains it.
constexpr double contained = 1e-13;

/// Part of the largest dimension below which half as many cuts are tried the next time: dimensions grow with the length of a
/// cut where motion oscillates, with its square root where it is damped.
constexpr double roomy = 0.7;

/// y += A x
void add_product(const SparseMatrix& A, const double* x, double* y) {
  Eigen::Map<Eigen::VectorXd>(y, A.rows()).noalias() += A * Eigen::Map<const Eigen::VectorXd>(x, A.cols());
}

/// A_ij factor/(r_i r_j), and 0 in pinned rows. Returns the largest sum of the moduli of a row.
double scale_entries(SparseMatrix& A, double factor, const Eigen::VectorXd& roots, const std::vector<bool>& pinned) {
  double largest = 0;
  for (int i = 0; i < A.outerSize(); ++i) {
    double sum = 0;
    for (SparseMatrix::InnerIterator entry(A, i); entry; ++entry) {
      entry.valueRef() *= pinned[i] ? 0 : factor / (roots[i] * roots[entry.col()]);
      sum += std::abs(entry.value());
    }
    largest = std::isnan(sum) ? sum : std::max(largest, sum);
  }
  return largest;
}

}  // namespace

PhiFunctions::PhiFunctions(const SplitOde& ode)
    : ode_(ode),
      n_(3 * ode.particles()),
      roots_(thrice(ode.mass).cwiseSqrt()),
      pinned_(n_, false),
      inputs_(Eigen::MatrixXd::Zero(2 * n_, most_inputs)),
      basis_(2 * n_ + most_inputs, most_dimensions + 1),
      H_(most_dimensions + 1, most_dimensions),
      projected_(most_dimensions + 1, most_dimensions + 1),
      state_(2 * n_),
      start_(most_dimensions + 1),
      end_(most_dimensions + 1),
      coordinates_(most_dimensions + 1),
      next_(most_dimensions + 1),
      exponential_(most_dimensions + 1),
      work_(*ode.work) {
  for (const Pin& pin : ode.pins)
    for (int c = 0; c < 3; ++c) pinned_[3 * pin.particle + c] = pin.fixed(c);
  if (const ObliquePins oblique(ode.pins); !oblique.empty()) free_ = oblique.matrix(ode.particles());
}

// With p = θ/h M^½ x and q = M^½ v, hJ becomes (0 θ; h²/θ M^-½ K M^-½, h M^-½ D M^-½): undamped springs make it nearly
// antisymmetric if θ is h times the largest frequency, and its norm hardly larger than its eigenvalues.
Outcome PhiFunctions::linearise(double h, double t, const State& y) {
  h_ = h;
  clear();
  ode_.jacobian(t, y.x, y.v, stiffness_, damping_);
  if (free_.nonZeros() > 0) {
    stiffness_ = SparseMatrix(free_ * stiffness_);
    damping_ = SparseMatrix(free_ * damping_);
  }
  const double stiffest = scale_entries(stiffness_, h * h, roots_, pinned_);
  const double decay = scale_entries(damping_, h, roots_, pinned_);
  if (!std::isfinite(stiffest + decay)) return Outcome::not_finite;
  theta_ = stiffest > 0 ? std::sqrt(stiffest) : 1;
  stiffness_ *= 1 / theta_;
  return Outcome::success;
}

void PhiFunctions::set_input(int p, const State& b) {
  auto column = inputs_.col(p - 1);
  column.head(n_).array() = theta_ / h_ * roots_.array() * b.x.reshaped<Eigen::RowMajor>().array();
  column.tail(n_).array() = roots_.array() * b.v.reshaped<Eigen::RowMajor>().array();
}

void PhiFunctions::get(const Eigen::Ref<const Eigen::VectorXd>& scaled, State& w) const {
  w.x.resize(n_ / 3, 3);
  w.v.resize(n_ / 3, 3);
  w.x.reshaped<Eigen::RowMajor>().array() = h_ / theta_ * scaled.head(n_).array() / roots_.array();
  w.v.reshaped<Eigen::RowMajor>().array() = scaled.segment(n_, n_).array() / roots_.array();
}

void PhiFunctions::multiply(const State& u, State& r) {
  positions(0).array() = theta_ / h_ * roots_.array() * u.x.reshaped<Eigen::RowMajor>().array();
  velocities(0).array() = roots_.array() * u.v.reshaped<Eigen::RowMajor>().array();
  basis_.col(0).tail(most_inputs).setZero();
  apply(0);
  get(basis_.col(1).head(2 * n_), r);
}

/// The next column: the equation with its inputs appended, times this one.
void PhiFunctions::apply(Eigen::Index column) {
  const auto powers = basis_.col(column).tail(most_inputs);
  auto next = basis_.col(column + 1);
  next.head(2 * n_).noalias() = inputs_ * powers;
  positions(column + 1) += theta_ * velocities(column);
  add_product(stiffness_, &basis_(0, column), &next[n_]);
  add_product(damping_, &basis_(n_, column), &next[n_]);
  next[2 * n_] = 0;
  next.tail(most_inputs - 1) = powers.head(most_inputs - 1);
  ++work_.jacobian_products;
  work_.bytes += multiply_bytes(stiffness_) + multiply_bytes(damping_);
}

/// Makes a column orthonormal to those before, twice where the first time leaves little of it; false if they span it.
bool PhiFunctions::orthogonalise(Eigen::Index column) {
  constexpr double little = 0.7;
  const auto before = basis_.leftCols(column);
  auto next = basis_.col(column), h = H_.col(column - 1);
  auto part = coordinates_.head(column);
  const double size = next.norm();
  h.setZero();
  residual_ = size;
  for (int k = 0; k < 2 && (k == 0 || residual_ < little * size); ++k) {
    part.noalias() = before.transpose() * next;
    next.noalias() -= before * part;
    h.head(column) += part;
    residual_ = next.norm();
    work_.bytes += 2 * vector_bytes(n_ / 3, 2) * column;
  }
  if (residual_ <= contained * size) residual_ = 0;
  h[column] = residual_;
  if (!(residual_ > 0)) return false;  // nor if it is not a number
  next /= residual_;
  return true;
}

/// The first vector of the space: where w has come, and the powers of c that the inputs go with.
void PhiFunctions::begin(const Progress& progress, int inputs, double size) {
  auto first = basis_.col(0);
  first.head(2 * n_) = state_;
  first.tail(most_inputs).setZero();
  double power = size;
  for (int p = 0; p < inputs; ++p) {
    first[2 * n_ + p] = power;
    power *= double(progress.done) / progress.all() / (p + 1);
  }
  beta_ = first.norm();
  first /= beta_;
}

Outcome PhiFunctions::evaluate(int parts, std::span<const Output> outputs, double error) {
  int inputs = most_inputs;
  while (inputs > 0 && inputs_.col(inputs - 1).isZero(0)) --inputs;
  const double size = inputs_.colwise().norm().maxCoeff();
  if (!std::isfinite(inputs_.sum())) return Outcome::not_finite;
  state_.setZero();
  if (inputs == 0)
    for (const Output& output : outputs) get(state_, *output.w);
  Expected& expected = expected_[inputs];
  Progress progress{parts, expected.cuts};
  if (inputs > 0) inputs_ /= size;
  Outcome outcome = Outcome::success;
  while (inputs > 0 && progress.left() > 0 && outcome == Outcome::success) {
    begin(progress, inputs, size);
    outcome = advance(progress, expected, outputs, error);
  }
  const bool fewer = expected.dimensions < roomy * most_dimensions;
  expected.cuts = outcome != Outcome::success ? 1 : fewer ? std::max(1, progress.cuts / 2) : progress.cuts;
  clear();
  return outcome;
}

/// Builds a space and goes as far in it as its error allows: to the end if it can be made large enough.
Outcome PhiFunctions::advance(Progress& progress, Expected& expected, std::span<const Output> outputs, double error) {
  Eigen::Index check = std::max<Eigen::Index>(check_period, expected.dimensions - check_period);
  for (Eigen::Index m = 1;; ++m) {
    apply(m - 1);
    const bool last = !orthogonalise(m) || m == most_dimensions;
    if (!std::isfinite(residual_)) return Outcome::not_finite;
    if (!last && m < check) continue;
    check = m + check_period;
    int units = units_within(m, progress, error);
    for (; last && units == 0; units = units_within(m, progress, error)) {
      if (progress.cuts == most_cuts) return Outcome::not_converged;
      progress.cuts *= 2;
      progress.done *= 2;
    }
    if (!last && units < progress.left()) continue;
    go(m, units, progress, outputs);
    expected.dimensions = static_cast<int>(m);
    return Outcome::success;
  }
}

/// Number of units after which the error is still within its share, in the space of the first m vectors: the last component of
/// τ φ_1(τ H) e_1, times what leads out of the space   [Saad 1992]. The matrix with e_1 appended has it in its exponential.
int PhiFunctions::units_within(Eigen::Index m, const Progress& progress, double error) {
  auto projected = projected_.topLeftCorner(m + 1, m + 1);
  const double unit = 1.0 / progress.all();
  projected.setZero();
  projected.topLeftCorner(m, m) = unit * H_.topLeftCorner(m, m);
  projected(0, m) = unit;
  exponential_.compute(projected);
  begin_coordinates(m);
  int units = 0;
  while (units < progress.left()) {
    propagate(m);
    if (!(beta_ * residual_ * std::abs(end_[m - 1]) <= error * unit * (units + 1))) break;
    ++units;
  }
  return units;
}

void PhiFunctions::begin_coordinates(Eigen::Index m) {
  start_.head(m + 1).setZero();
  end_.head(m + 1).setZero();
  start_[0] = end_[m] = 1;
}

/// exp(τ H) e_1 and τ φ_1(τ H) e_1, a unit further.
void PhiFunctions::propagate(Eigen::Index m) {
  for (Eigen::VectorXd* column : {&start_, &end_}) {
    next_.head(m + 1).noalias() = exponential_.result() * column->head(m + 1);
    column->head(m + 1) = next_.head(m + 1);
  }
}

void PhiFunctions::go(Eigen::Index m, int units, Progress& progress, std::span<const Output> outputs) {
  begin_coordinates(m);
  for (int k = 1; k <= units; ++k) {
    propagate(m);
    ++progress.done;
    const auto wanted = std::ranges::find(outputs, progress.done, [&](const Output& o) { return o.part * progress.cuts; });
    if (k < units && wanted == outputs.end()) continue;
    coordinates_.head(m) = beta_ * start_.head(m);
    state_.noalias() = basis_.topLeftCorner(2 * n_, m) * coordinates_.head(m);
    if (residual_ > 0) state_ += beta_ * residual_ * end_[m - 1] * basis_.col(m).head(2 * n_);
    if (wanted != outputs.end()) get(state_, *wanted->w);
  }
}

}  // namespace drape::solver
