#pragma once

#include <array>
#include <span>

#include "solver/linear/counters.hpp"
#include "solver/linear/matrix_exponential.hpp"
#include "solver/outcome.hpp"
#include "solver/split_ode.hpp"

namespace drape::solver {

/// Functions of the exact Jacobian J of (v, M⁻¹ f), of which only products with vectors are used:
///   w(c) = Σ_p c^p φ_p(c h J) b_p,   φ_p(z) = ∫ exp((1 − s) z) s^(p−1)/(p − 1)! ds over 0 to 1,
/// which solves w' = h J w + Σ_p c^(p−1)/(p − 1)! b_p from w(0) = 0. One Krylov space of the equation with its inputs appended
/// [Al-Mohy, Higham 2011; Niesen, Wright 2012] gives w at several c. It grows until its estimated error [Saad 1992] is small
/// enough; where that takes more dimensions than there are, the way to c = 1 is cut, as in Expokit [Sidje 1998].
///
/// The space holds 181 states: 9 kB a particle. Rows of pinned coordinates are 0 in J; w moves them only as b_1 does. After the
/// first step no call allocates unless the pattern of the Jacobian changes.
class PhiFunctions {
 public:
  static constexpr int most_inputs = 4;

  explicit PhiFunctions(const SplitOde& ode);

  /// Takes the Jacobian at (t, y) for a step h > 0.
  Outcome linearise(double h, double t, const State& y);

  /// r = h J u.
  void multiply(const State& u, State& r);

  /// Sets b_p, p from 1 on, of x [m] and v [m/s]; b_p = 0 until it is set after `linearise` or `evaluate`.
  void set_input(int p, const State& b);

  /// Size of b_p in the norm in which errors count: about the square root of the energy, with all springs the stiffest.
  double size(int p) const { return inputs_.col(p - 1).norm(); }

  /// w at c = part/parts.
  struct Output {
    int part;
    State* w;
  };

  /// Sets w at the outputs, in ascending order, of which the last must be at c = 1, with an estimated error of at most `error`
  /// in the norm of `size`. `not_converged` if that takes too many cuts.
  Outcome evaluate(int parts, std::span<const Output> outputs, double error);

 private:
  static constexpr int most_dimensions = 180;
  static constexpr int most_cuts = 1024;  ///< of a part
  static constexpr int check_period = 6;  ///< dimensions between two estimates of the error

  /// How far c has come: done of parts × cuts units.
  struct Progress {
    int parts, cuts, done = 0;

    int all() const { return parts * cuts; }
    int left() const { return all() - done; }
  };

  /// What the next evaluation with as many inputs begins with.
  struct Expected {
    int dimensions = 0, cuts = 1;
  };

  void clear() { inputs_.setZero(); }
  void apply(Eigen::Index column);
  bool orthogonalise(Eigen::Index column);
  void begin(const Progress& progress, int inputs, double size);
  Outcome advance(Progress& progress, Expected& expected, std::span<const Output> outputs, double error);
  int units_within(Eigen::Index m, const Progress& progress, double error);
  void go(Eigen::Index m, int units, Progress& progress, std::span<const Output> outputs);
  void begin_coordinates(Eigen::Index m);
  void propagate(Eigen::Index m);
  auto positions(Eigen::Index column) { return basis_.col(column).head(n_); }
  auto velocities(Eigen::Index column) { return basis_.col(column).segment(n_, n_); }
  void get(const Eigen::Ref<const Eigen::VectorXd>& scaled, State& w) const;

  const SplitOde& ode_;
  const Eigen::Index n_;  ///< 3N
  double h_ = 0, theta_ = 1;
  SparseMatrix stiffness_, damping_;  ///< h²/θ M^-½ ∂f/∂x M^-½ and h M^-½ ∂f/∂v M^-½, 3N × 3N
  Eigen::VectorXd roots_;             ///< of the masses, 3N
  std::vector<bool> pinned_;          ///< 3N
  SparseMatrix free_;                 ///< projector on the directions that oblique pins leave; or empty
  Eigen::MatrixXd inputs_;            ///< 6N × most_inputs, scaled as states are
  Eigen::MatrixXd basis_;             ///< 6N + most_inputs rows: scaled states, and the powers of c that the inputs go with
  Eigen::MatrixXd H_, projected_;     ///< the equation in the space, and with e_1 appended
  double beta_ = 0, residual_ = 0;    ///< of the first vector: its size; of the last product: what leads out of the space
  Eigen::VectorXd state_;             ///< w where c has come, scaled
  Eigen::VectorXd start_, end_;       ///< exp(τ H) e_1 and τ φ_1(τ H) e_1
  Eigen::VectorXd coordinates_, next_;
  MatrixExponential exponential_;
  std::array<Expected, most_inputs + 1> expected_{};  ///< by the number of inputs
  LinearCounters work_;
};

}  // namespace drape::solver
