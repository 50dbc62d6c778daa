#include "solver/methods/desbrun.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <limits>

#include "solver/linear/kernels.hpp"
#include "solver/methods/constant_matrix.hpp"

namespace drape::solver {
namespace {

/// Above, a dense inverse takes more than 200 MB, and minutes.
constexpr int most_inverted = 5000;

/// A and its inverses, as dense matrices: one for each coordinate, those with the same pins once.
struct DenseInverses {
  ConstantMatrix A;
  std::vector<std::vector<bool>> pinned;  ///< of each inverse, which particles
  std::vector<Eigen::MatrixXd> inverses;
  std::array<int, 3> of_coordinate{};
  Eigen::VectorXd free_mass;  ///< 0 of particles with pins
  struct Held {
    int particle;
    Eigen::Vector3d direction;
  };
  std::vector<Held> held;  ///< of oblique pins, orthonormal for each particle
  Eigen::MatrixXd solved;  ///< (C A⁻¹ Cᵀ)⁻¹ for the components C in these directions
  Outcome outcome = Outcome::success;

  /// The entry (i, j) of A⁻¹ between two directions.
  double inverse(const Held& i, const Held& j) const {
    double sum = 0;
    for (int c = 0; c < 3; ++c) sum += i.direction[c] * j.direction[c] * inverses[of_coordinate[c]](i.particle, j.particle);
    return sum;
  }

  /// What multipliers in the held directions leave of A⁻¹ r: nothing in these.
  void hold(Vectors& dv) const;

  explicit DenseInverses(const SplitOde& ode);
  void invert(int particles);
};

DenseInverses::DenseInverses(const SplitOde& ode) : A(ode), free_mass(ode.mass) {
  for (const Pin& pin : ode.pins) free_mass[pin.particle] = 0;
  for (int c = 0; c < 3; ++c) {
    std::vector<bool> mine(ode.particles(), false);
    for (const Pin& pin : ode.pins) mine[pin.particle] = pin.fixed(c);
    const auto known = std::ranges::find(pinned, mine);
    of_coordinate[c] = static_cast<int>(known - pinned.begin());
    if (known == pinned.end()) pinned.push_back(mine);
  }
  for (const Pin& pin : ode.pins) {
    if (!pin.oblique()) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> found(pin.held - axes(pin.fixed(0), pin.fixed(1), pin.fixed(2)));
    for (int k = 0; k < 3; ++k)
      if (found.eigenvalues()[k] > 0.5) held.push_back({pin.particle, found.eigenvectors().col(k)});
  }
}

void DenseInverses::hold(Vectors& dv) const {
  Eigen::VectorXd components(std::ssize(held));
  for (Eigen::Index k = 0; k < components.size(); ++k) components[k] = held[k].direction.dot(dv.row(held[k].particle));
  const Eigen::VectorXd multipliers = solved * components;
  for (Eigen::Index k = 0; k < components.size(); ++k)
    for (int c = 0; c < 3; ++c)
      dv.col(c) -= multipliers[k] * held[k].direction[c] * inverses[of_coordinate[c]].col(held[k].particle);
}

/// Rows and columns of pinned particles are those of the identity, so that what is 0 there remains 0.
void DenseInverses::invert(int particles) {
  outcome = particles > most_inverted ? Outcome::out_of_memory : Outcome::success;
  if (outcome != Outcome::success) return;
  inverses.clear();
  for (const std::vector<bool>& gone : pinned) {
    Eigen::MatrixXd dense = A();
    for (int i = 0; i < particles; ++i) {
      if (!gone[i]) continue;
      dense.row(i).setZero();
      dense.col(i).setZero();
      dense(i, i) = 1;
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(dense);
    if (factor.info() != Eigen::Success) outcome = Outcome::breakdown;
    inverses.emplace_back(factor.solve(Eigen::MatrixXd::Identity(particles, particles)));
  }
  const Eigen::Index n = std::ssize(held);
  solved = Eigen::MatrixXd::NullaryExpr(n, n, [this](Eigen::Index i, Eigen::Index j) { return inverse(held[i], held[j]); });
  if (n > 0) solved = Eigen::LLT<Eigen::MatrixXd>(solved).solve(Eigen::MatrixXd::Identity(n, n));
}

/// v1 of IMEX Euler by A⁻¹.
void multiply_by_inverse(Step& s, DenseInverses& dense) {
  const State& y0 = s.y0();
  Vectors &r = s.scratch.f_hat, &v1 = s.y1().v;
  s.error.constant = 1.0 / 2;
  if (dense.A.make(s.h)) dense.invert(s.ode.particles());
  s.result.outcome = dense.outcome;
  if (dense.outcome != Outcome::success) return;
  dense.A.right_side(s.t, y0, r, s.scratch.ax);
  for (int c = 0; c < 3; ++c) {
    const Eigen::MatrixXd& inverse = dense.inverses[dense.of_coordinate[c]];
    s.scratch.av.col(c).noalias() = inverse * r.col(c);
  }
  if (!dense.held.empty()) dense.hold(s.scratch.av);
  v1 = y0.v + s.scratch.av;
  ++dense.A.work().updates;
  ++s.result.updates;
}

/// J⁺ L for the moments of inertia J, whose zeros, those of a row of particles about itself, are left out.
Eigen::Vector3d angular_velocity(const Eigen::Matrix3d& J, const Eigen::Vector3d& L) {
  constexpr double zero = 1e-12;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(J);
  Eigen::Vector3d along = axes.eigenvectors().transpose() * L;
  for (int k = 0; k < 3; ++k) {
    const double moment = axes.eigenvalues()[k];
    along[k] = moment > zero * axes.eigenvalues()[2] ? along[k] / moment : 0;
  }
  return axes.eigenvectors() * along;
}

/// Turns v1 about the centre of the particles without pins, by what the springs' h K v1 has added to their angular momentum
/// since the forces at x0.
void restore_angular_momentum(Step& s, const Eigen::VectorXd& mass) {
  const Vectors& x = s.y0().x;
  Vectors &v1 = s.y1().v, &K_v1 = s.scratch.av;
  multiply(s.ode.stiffness, v1, K_v1);
  const Eigen::RowVector3d centre = mass.transpose() * x / std::max(mass.sum(), std::numeric_limits<double>::min());
  Eigen::Vector3d L = Eigen::Vector3d::Zero();
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
  for (int i = 0; i < mass.size(); ++i) {
    if (mass[i] == 0) continue;
    const Eigen::Vector3d r = x.row(i) - centre;
    L += s.h * s.h * r.cross(Eigen::Vector3d(K_v1.row(i)));
    J += mass[i] * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
  }
  const Eigen::Vector3d omega = angular_velocity(J, L);
  for (int i = 0; i < mass.size(); ++i)
    if (mass[i] != 0) v1.row(i) -= omega.cross(Eigen::Vector3d(x.row(i) - centre));
}

}  // namespace

void desbrun_without_correction(Step& s) {
  multiply_by_inverse(s, s.keep<DenseInverses>());
  s.y1().x = s.y0().x + s.h * s.y1().v;
}

// v1 = A⁻¹ b, A v1 = b being that of `imex-euler`, with A⁻¹ as a dense matrix;  v1 −= ω × (x0 − x_G),  x1 = x0 + h v1
// [Desbrun, Schröder, Barr 1999; Etzmuß 2002, 3.2]: K (x0 + h v1) with the constant K turns what is free, which the springs
// themselves do not. The torque of damping is left as it is, and what is pinned is not turned: sheets without pins keep their
// angular momentum, hung ones are corrected as if the pins were not there.
void desbrun(Step& s) {
  auto& dense = s.keep<DenseInverses>();
  multiply_by_inverse(s, dense);
  if (s.result.outcome != Outcome::success) return;
  restore_angular_momentum(s, dense.free_mass);
  s.y1().x = s.y0().x + s.h * s.y1().v;
}

}  // namespace drape::solver
