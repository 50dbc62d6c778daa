#include "solver/methods.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "solver/added_methods.hpp"
#include "solver/base/printable.hpp"
#include "solver/base/registry.hpp"
#include "solver/base/row_name.hpp"

namespace drape::solver {

// Each in its file under solver/methods/.
void imex_euler(Step& s);
void implicit_euler(Step& s);
void sbdf2(Step& s);
void bdf2(Step& s);
void midpoint(Step& s);
void imex_midpoint(Step& s);
void verlet(Step& s);
void tr_bdf2(Step& s);
void esdirk3(Step& s);
void esdirk4(Step& s);
void bdf3(Step& s);
void bdf4(Step& s);
void bdf5(Step& s);
void baraff_witkin(Step& s);
void one_newton_bdf2(Step& s);
void ros2(Step& s);
void ros3p(Step& s);
void rodas3(Step& s);
void ros34pw2(Step& s);
void ros2_w(Step& s);
void ros34pw2_w(Step& s);
void explicit_euler(Step& s);
void explicit_midpoint(Step& s);
void rk4(Step& s);
void rk4_substeps(Step& s);
void bridson(Step& s);
void rkl2(Step& s);
void rkc2(Step& s);
void rock2(Step& s);
void generalized_alpha(Step& s);
void generalized_alpha_half(Step& s);
void newmark(Step& s);
void hht(Step& s);
void energy_momentum(Step& s);
void xpbd(Step& s);
void xpbd_jacobi(Step& s);
void baraff_witkin_cg(Step& s);
void desbrun(Step& s);
void kang(Step& s);
void strain_limited(Step& s);
void exponential_euler(Step& s);
void epirk4s3a(Step& s);

namespace {

using Stages = Method::Stages;
using Repeats = Method::Repeats;
constexpr Method method_rows[] = {
    {.name = "imex-euler",
     .description = "IMEX Euler (3.23)",
     .order = 1,
     .stages = Stages::linear,
     .step = imex_euler,
     .forces = 1,
     .in_thesis = true},
    {.name = "implicit-euler",
     .description = "implicit Euler (3.33)",
     .order = 1,
     .stages = Stages::nonlinear,
     .step = implicit_euler,
     .in_thesis = true},
    {.name = "sbdf2",
     .description = "SBDF(2), semi-implicit BDF (3.29)",
     .order = 2,
     .stages = Stages::linear,
     .step = sbdf2,
     .history = 2,
     .forces = 2,
     .in_thesis = true},
    {.name = "bdf2",
     .description = "BDF(2) (3.35)",
     .order = 2,
     .stages = Stages::nonlinear,
     .step = bdf2,
     .history = 2,
     .in_thesis = true},
    {.name = "midpoint",
     .description = "implicit midpoint rule (3.26)",
     .order = 2,
     .stages = Stages::nonlinear,
     .step = midpoint,
     .in_thesis = true},
    {.name = "imex-midpoint",
     .description = "IMEX midpoint rule, ARS(1,2,2) (3.4.1)",
     .order = 2,
     .stages = Stages::linear,
     .step = imex_midpoint,
     .forces = 1,
     .in_thesis = true},
    {.name = "verlet",
     .description = "velocity Verlet, explicit, sub-stepped inside its stability limit",
     .order = 2,
     .stages = Stages::none,
     .step = verlet,
     .forces = 1,
     .sub_steps = true,
     .in_thesis = true},
    {.name = "tr-bdf2",
     .description = "TR-BDF2, one step of two stages, L-stable",
     .order = 2,
     .stages = Stages::nonlinear,
     .step = tr_bdf2,
     .forces = 1,
     .meets_obstacles = false},
    {.name = "esdirk3",
     .description = "ESDIRK3(2)4L[2]SA, L-stable",
     .order = 3,
     .stages = Stages::nonlinear,
     .step = esdirk3,
     .forces = 1,
     .meets_obstacles = false},
    {.name = "esdirk4",
     .description = "ESDIRK4(3)6L[2]SA, L-stable",
     .order = 4,
     .stages = Stages::nonlinear,
     .step = esdirk4,
     .forces = 1,
     .meets_obstacles = false},
    {.name = "bdf3",
     .description = "BDF(3), stable for angles up to 86 degrees",
     .order = 3,
     .stages = Stages::nonlinear,
     .step = bdf3,
     .history = 3,
     .forces = 1,
     .meets_obstacles = false},
    {.name = "bdf4",
     .description = "BDF(4), up to 73 degrees",
     .order = 4,
     .stages = Stages::nonlinear,
     .step = bdf4,
     .history = 4,
     .forces = 1,
     .meets_obstacles = false},
    {.name = "bdf5",
     .description = "BDF(5), up to 51 degrees",
     .order = 5,
     .stages = Stages::nonlinear,
     .step = bdf5,
     .history = 5,
     .forces = 1,
     .meets_obstacles = false},
    {.name = "baraff-witkin",
     .description = "linearly implicit Euler of Baraff and Witkin, one system with the exact Jacobian",
     .order = 1,
     .stages = Stages::linearised,
     .step = baraff_witkin,
     .meets_obstacles = false},
    {.name = "one-newton-bdf2",
     .description = "BDF(2) of Choi and Ko, one Newton step",
     .order = 2,
     .stages = Stages::linearised,
     .step = one_newton_bdf2,
     .history = 2,
     .meets_obstacles = false},
    {.name = "ros2",
     .description = "Rosenbrock method ROS2, L-stable",
     .order = 2,
     .stages = Stages::linearised,
     .step = ros2,
     .meets_obstacles = false},
    {.name = "ros3p",
     .description = "Rosenbrock method ROS3P, A-stable",
     .order = 3,
     .stages = Stages::linearised,
     .step = ros3p,
     .meets_obstacles = false},
    {.name = "rodas3",
     .description = "Rosenbrock method RODAS3, L-stable",
     .order = 3,
     .stages = Stages::linearised,
     .step = rodas3,
     .meets_obstacles = false},
    {.name = "ros34pw2",
     .description = "Rosenbrock method ROS34PW2, L-stable",
     .order = 3,
     .stages = Stages::linearised,
     .step = ros34pw2,
     .meets_obstacles = false},
    {.name = "ros2-w",
     .description = "ROS2 with the constant matrix, frozen where hk/d is large",
     .order = 2,
     .stages = Stages::linear,
     .step = ros2_w,
     .meets_obstacles = false},
    {.name = "ros34pw2-w",
     .description = "ROS34PW2 with the constant matrix, frozen where hk/d is large",
     .order = 3,
     .stages = Stages::linear,
     .step = ros34pw2_w,
     .meets_obstacles = false},
    {.name = "explicit-euler",
     .description = "explicit Euler (3.4)",
     .order = 1,
     .stages = Stages::none,
     .step = explicit_euler,
     .meets_obstacles = false},
    {.name = "explicit-midpoint",
     .description = "explicit midpoint rule (3.4.1)",
     .order = 2,
     .stages = Stages::none,
     .step = explicit_midpoint,
     .meets_obstacles = false},
    {.name = "rk4",
     .description = "classical Runge-Kutta, explicit",
     .order = 4,
     .stages = Stages::none,
     .step = rk4,
     .meets_obstacles = false},
    {.name = "rk4-substeps",
     .description = "classical Runge-Kutta, sub-stepped inside its stability limit",
     .order = 4,
     .stages = Stages::none,
     .step = rk4_substeps,
     .meets_obstacles = false,
     .sub_steps = true},
    {.name = "bridson",
     .description = "explicit springs, implicit damping, sub-stepped inside a limit that damping does not lower",
     .order = 2,
     .stages = Stages::linear,
     .step = bridson,
     .sub_steps = true},
    {.name = "rkl2",
     .description = "Runge-Kutta-Legendre, explicit, as many stages as damping demands",
     .order = 2,
     .stages = Stages::none,
     .step = rkl2,
     .meets_obstacles = false},
    {.name = "rkc2",
     .description = "Runge-Kutta-Chebyshev, explicit, as many stages as damping demands",
     .order = 2,
     .stages = Stages::none,
     .step = rkc2,
     .meets_obstacles = false},
    {.name = "rock2",
     .description = "orthogonal Runge-Kutta-Chebyshev, explicit, as many stages as damping demands",
     .order = 2,
     .stages = Stages::none,
     .step = rock2,
     .meets_obstacles = false},
    {.name = "generalized-alpha",
     .description = "generalised alpha of Chung and Hulbert, spectral radius 0.8 at infinity",
     .order = 2,
     .stages = Stages::nonlinear,
     .step = generalized_alpha,
     .forces = 1,
     .meets_obstacles = false},
    {.name = "generalized-alpha-0.5",
     .description = "the same with the radius 0.5",
     .order = 2,
     .stages = Stages::nonlinear,
     .step = generalized_alpha_half,
     .forces = 1,
     .meets_obstacles = false},
    {.name = "newmark",
     .description = "trapezoidal rule of Newmark",
     .order = 2,
     .stages = Stages::nonlinear,
     .step = newmark,
     .forces = 1,
     .meets_obstacles = false},
    {.name = "hht",
     .description = "alpha method of Hilber, Hughes and Taylor, alpha 0.1",
     .order = 2,
     .stages = Stages::nonlinear,
     .step = hht,
     .forces = 1,
     .meets_obstacles = false},
    {.name = "energy-momentum",
     .description = "discrete gradient of every energy, keeps energy and both momenta",
     .order = 2,
     .stages = Stages::nonlinear,
     .step = energy_momentum,
     .meets_obstacles = false,
     .needs_energies = true},
    {.name = "xpbd",
     .description = "extended position-based dynamics, 20 sub-steps of one Gauss-Seidel sweep unless named as xpbd/4x5",
     .order = 1,
     .stages = Stages::linear,
     .step = xpbd,
     .meets_obstacles = false,
     .repeats = Repeats::sub_steps_and_sweeps,
     .own_family = "position-based"},
    {.name = "xpbd-jacobi",
     .description = "the same with Jacobi sweeps",
     .order = 1,
     .stages = Stages::linear,
     .step = xpbd_jacobi,
     .meets_obstacles = false,
     .repeats = Repeats::sub_steps_and_sweeps,
     .own_family = "position-based"},
    {.name = "baraff-witkin-cg",
     .description = "baraff-witkin by conjugate gradients as in the paper, with the symmetric part of the Jacobian",
     .order = 1,
     .stages = Stages::linearised,
     .step = baraff_witkin_cg,
     .meets_obstacles = false},
    {.name = "desbrun",
     .description = "IMEX Euler of Desbrun, by a dense inverse, which then restores the angular momentum",
     .order = 1,
     .stages = Stages::own,
     .step = desbrun,
     .meets_obstacles = false},
    {.name = "kang",
     .description = "IMEX Euler of Kang, which divides by the diagonal: does not converge where there is damping",
     .order = 1,
     .stages = Stages::own,
     .step = kang,
     .meets_obstacles = false,
     .repeats = Repeats::sweeps,
     .converges = false},
    {.name = "strain-limited",
     .description = "Verlet with springs a hundred times softer, then cut to a tenth of strain (Provot): does not converge",
     .order = 1,
     .stages = Stages::none,
     .step = strain_limited,
     .meets_obstacles = false,
     .sub_steps = true,
     .repeats = Repeats::sweeps,
     .converges = false},
    {.name = "exponential-euler",
     .description = "exponential Rosenbrock-Euler, exact for linear forces, by Krylov spaces",
     .order = 2,
     .stages = Stages::exponential,
     .step = exponential_euler,
     .meets_obstacles = false},
    {.name = "epirk4s3a",
     .description = "exponential method EPIRK4s3A, exact for linear forces, by Krylov spaces",
     .order = 4,
     .stages = Stages::exponential,
     .step = epirk4s3a,
     .meets_obstacles = false},
};

constexpr auto thesis_rows =
    std::count_if(std::begin(method_rows), std::end(method_rows), [](const Method& m) { return m.in_thesis; });
static_assert(std::all_of(method_rows, method_rows + thesis_rows, [](const Method& m) { return m.in_thesis; }),
              "those of the thesis first");

constexpr std::size_t most_added = 64;

/// The rows, and those that are added. Its memory does not move: rows are known by their addresses.
std::vector<Method>& method_table() {
  static std::vector<Method> all = [] {
    std::vector<Method> rows;
    rows.reserve(std::size(method_rows) + most_added);
    rows.assign(std::begin(method_rows), std::end(method_rows));
    return rows;
  }();
  return all;
}

}  // namespace

std::string_view Method::family() const {
  if (!own_family.empty()) return own_family;
  if (explicit_springs()) return "explicit";
  if (stages == Stages::linear || stages == Stages::own) return "semi-implicit";
  if (stages == Stages::linearised) return "linearly implicit";
  if (stages == Stages::exponential) return "exponential";
  return history > 1 ? "implicit multi-step" : "implicit one-step";
}

std::span<const Method> methods() { return method_table(); }

void add_methods(std::span<const Method> rows) {
  std::vector<Method>& all = method_table();
  for (const Method& row : rows) {
    const std::string name = "method '" + base::quoted(row.name) + "': ";
    if (!base::is_row_name(row.name)) throw std::invalid_argument(name + std::string(base::row_name_rule));
    if (std::ranges::find(all, row.name, &Method::name) != all.end())
      throw std::invalid_argument(name + "there is one of this name; expected another");
    if (row.step == nullptr || row.order < 1) throw std::invalid_argument(name + "expected a step and an order from 1 on");
    if (row.in_thesis) throw std::invalid_argument(name + "expected in_thesis = false: these are ours");
    if (all.size() == all.capacity())
      throw std::invalid_argument(name + "expected at most " + std::to_string(most_added) + " that are added");
    all.push_back(row);
  }
}

std::span<const Method> thesis_methods() { return methods().first(thesis_rows); }

const Method& method(std::string_view name) { return base::find_named(methods(), "method", name); }

}  // namespace drape::solver
