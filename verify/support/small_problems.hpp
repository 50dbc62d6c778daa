#pragma once

#include <string>
#include <vector>

#include "solver/integrator.hpp"
#include "verify/support/known_motions.hpp"

/// Small split equations of motion for the tests of solver/: nonlinear, depending on time and velocity, solved by a motion that
/// was chosen beforehand.
namespace drape::verify::small_problems {

using known_motions::Problem;
using known_motions::threefold;
using solver::Method;
using solver::Options;
using solver::Pin;
using solver::SparseMatrix;
using solver::SplitOde;
using solver::State;
using solver::Vectors;

constexpr int particles = 5;
constexpr double start_time = 0.4;  ///< [s], not zero, so that nothing can leave it out

Options tolerances(double loop, double cg);

/// So tight that what is left of the error is the method's own.
Options tight();

/// Numbers between −1 and 1.
Vectors noise(int n, unsigned seed);

double largest(const Eigen::MatrixXd& a);
double distance(const State& a, const State& b);

struct Spring {
  int i, j;
  double k, d;
};
inline constexpr Spring springs[] = {{0, 1, 12, 0.4}, {1, 2, 8, 0.9}, {2, 3, 9, 0.2},
                                     {3, 4, 5, 0.7},  {0, 3, 7, 0.5}, {1, 4, 6, 0.3}};

Eigen::VectorXd masses();

/// The graph Laplacian of the springs with one of their coefficients for weights.
SparseMatrix laplacian(double Spring::*weight);

/// The nonlinear part: springs that weaken as they stretch and breathe with time, and a drag that grows with the speed:
///   f_i = Σ_j a(t) r_ij / sqrt(1 + |r_ij|²) − b(t) |v_i|² v_i,   r_ij = x_j − x_i.
struct Nonlinear {
  static Vectors force(double t, const Vectors& x, const Vectors& v);

  /// Adds what the mean force between x0 and x1 has more than that in the middle: the energy of a spring is a(t) sqrt(1 +
  /// |r|²).
  static void mean_excess(double t, const Vectors& x0, const Vectors& x1, Vectors& f);

  /// Adds to the derivatives, both 3N × 3N.
  static void jacobian(double t, const Vectors& x, const Vectors& v, Eigen::MatrixXd& df_dx, Eigen::MatrixXd& df_dv);
};

/// M x'' = K x + D x' + g(t, x, x') + what is left over when a chosen motion is inserted; the pins differ.
Problem free_particles();
Problem pinned_particle();
Problem towed_particle();
Problem partly_pinned();
Problem obliquely_pinned();

/// A problem whose force is not finite after a time, and whose matrix is not definite for long steps, as some methods look at
/// the force only at the beginning of a step.
Problem breaking(double time);

std::vector<Problem> problems();

/// Tests are parameterised by the names of rows, which GoogleTest can print.
template <class Rows>
std::vector<std::string> names(Rows&& rows) {
  std::vector<std::string> result;
  for (const auto& row : rows) result.emplace_back(row.name);
  return result;
}
std::vector<Method> implicit_methods();
std::vector<Method> converging_methods();
Problem problem_named(const std::string& name);

/// A name as GoogleTest wants it in the name of a test.
std::string identifier(std::string name);

}  // namespace drape::verify::small_problems
