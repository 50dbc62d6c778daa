#pragma once

#include <complex>
#include <string_view>
#include <vector>

#include "reference/exact/modes.hpp"
#include "solver/methods.hpp"

/// What a method does to a linear mode: from its running step function, and in theory.
namespace drape::reference {

/// A linear mode, scaled by the step h of a method.
struct Mode {
  double nu;              ///< h² κ, the implicit part of the split
  double W;               ///< h² ω², the whole
  double s;               ///< h c, all of it implicit: in D
  double stiffest_s = 0;  ///< that of the sheet's most damped mode, if it is more: methods may choose their stages by it
};

Mode at_step(const LinearMode& mode, double h);

/// The mode as the equation of motion of one particle, each of whose coordinates moves by itself.
solver::SplitOde mode_ode(const LinearMode& mode);

// --- From the running code ------------------------------------------------------------------------------------------------

/// The matrix by which one step of the method multiplies (x, h v); of methods that need k states in companion form, with equal
/// steps, (x0, h v0, x₋₁, h v₋₁, …); of methods that keep accelerations (x, h v, h² a), of `verlet` with a single sub-step,
/// stable or not.
///
/// Its columns are the step function's results for unit vectors, with tolerances at round-off. Where the fixed-point loop would
/// take more than some 10⁵ updates or diverge, or may do so, the mode's κ is replaced by ω²: the loop's limit does not depend
/// on the split. Throws std::runtime_error if a step fails.
Eigen::MatrixXd amplification_matrix(const solver::Method& method, const Mode& mode);

/// Its eigenvalues, the largest modulus first.
std::vector<std::complex<double>> amplification_factors(const solver::Method& method, const Mode& mode);

/// Largest modulus of the factors.
double spectral_radius(const solver::Method& method, const Mode& mode);

/// The smallest step [s] from which on a mode with ω > 0 grows, by bisection on the spectral radius; infinite if there is none
/// with h max(ω, c) < 1600, 0 if it grows at h max(ω, c) = 0.1 already. Growth by less than 1e-7 a step counts as none.
double stability_limit(const solver::Method& method, const LinearMode& mode);

/// How a mode moves, x ~ exp(−decay t/h) cos(frequency t/h).
struct ModeBehaviour {
  double frequency;  ///< [rad] a step, 0 if overdamped
  double decay;      ///< of the amplitude a step, negative if it grows; of the slower part if overdamped
};

/// Its motion by the method: frequency = |arg z| and decay = −ln |z| of the dominant factor z.
ModeBehaviour measured_behaviour(const solver::Method& method, const Mode& mode);

/// Its exact motion.
ModeBehaviour exact_behaviour(const Mode& mode);

// --- In theory: those that take the name of a method throw std::invalid_argument if there is no theory of it
// ------------------

/// Whether there is one: for the methods of the thesis, explicit ones, and the methods of linearised stages.
bool has_theory(std::string_view method);

/// Characteristic polynomial of the amplification matrix, coefficients from the constant to the leading one, which is 1.
Eigen::VectorXd characteristic_polynomial(std::string_view method, const Mode& mode);

/// Distance of the characteristic polynomial of the running step on one mode from that in theory of another (or the same),
/// relative to its largest coefficient; infinite if the degrees differ.
double distance_from_theory(const solver::Method& method, const Mode& mode, const Mode& theory);

/// The factor by which an update of the fixed-point loop multiplies the error, γ² |κ − ω²|/(1 + γ² κ + γ c). 0 for methods
/// that have no loop.
double loop_contraction(std::string_view method, const Mode& mode);

/// The largest stable W for given ν and s, in closed form: infinite for the implicit methods, NaN where none is known, and for
/// explicit Runge-Kutta methods with s > 2, which too small a W makes unstable as well.
double stability_bound(std::string_view method, double nu, double s);

/// What a method adds to the equation of motion of a slow mode, (1 + inertia) x'' + (s + damping) x' + W x = 0 with h = 1.
struct Artificial {
  double inertia, damping;
};
Artificial artificial(std::string_view method, const Mode& mode);

/// The behaviour that follows from the artificial inertia and damping. The relative error of decay ± i frequency is of second
/// order in its modulus, for every ν; ν itself needs not be small.
ModeBehaviour predicted_behaviour(std::string_view method, const Mode& mode);

}  // namespace drape::reference
