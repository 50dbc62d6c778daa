#include "solver/methods.hpp"

#include "solver/base/registry.hpp"

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

std::span<const Method> methods() {
  using Stages = Method::Stages;
  static constexpr Method table[] = {
      {"imex-euler", "IMEX Euler (3.23)", 1, false, true, Stages::linear, imex_euler},
      {"implicit-euler", "implicit Euler (3.33)", 1, false, false, Stages::nonlinear, implicit_euler},
      {"sbdf2", "SBDF(2), semi-implicit BDF (3.29)", 2, true, true, Stages::linear, sbdf2},
      {"bdf2", "BDF(2) (3.35)", 2, true, false, Stages::nonlinear, bdf2},
      {"midpoint", "implicit midpoint rule (3.26)", 2, false, false, Stages::nonlinear, midpoint},
      {"imex-midpoint", "IMEX midpoint rule, ARS(1,2,2) (3.4.1)", 2, false, true, Stages::linear, imex_midpoint},
      {"verlet", "velocity Verlet, explicit, sub-stepped inside its stability limit", 2, false, true, Stages::none, verlet, 0,
       true, true},
      {"tr-bdf2", "TR-BDF2, one step of two stages, L-stable", 2, false, true, Stages::nonlinear, tr_bdf2, 0, false},
      {"esdirk3", "ESDIRK3(2)4L[2]SA, L-stable", 3, false, true, Stages::nonlinear, esdirk3, 0, false},
      {"esdirk4", "ESDIRK4(3)6L[2]SA, L-stable", 4, false, true, Stages::nonlinear, esdirk4, 0, false},
      {"bdf3", "BDF(3), stable for angles up to 86 degrees", 3, false, true, Stages::nonlinear, bdf3, 3, false},
      {"bdf4", "BDF(4), up to 73 degrees", 4, false, true, Stages::nonlinear, bdf4, 4, false},
      {"bdf5", "BDF(5), up to 51 degrees", 5, false, true, Stages::nonlinear, bdf5, 5, false},
  };
  return table;
}

std::span<const Method> thesis_methods() { return methods().first(7); }

const Method& method(std::string_view name) { return base::find_named(methods(), "method", name); }

}  // namespace drape::solver
