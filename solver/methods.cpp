#include "solver/methods.hpp"

#include "solver/named.hpp"

namespace drape::solver {

std::span<const Method> methods() {
  static constexpr Method table[] = {
      {"imex-euler", "IMEX Euler (3.23)", 1, false, true, "linear", imex_euler},
      {"implicit-euler", "implicit Euler (3.33)", 1, false, false, "fixed-point", implicit_euler},
      {"sbdf2", "SBDF(2), semi-implicit BDF (3.29)", 2, true, true, "linear", sbdf2},
      {"bdf2", "BDF(2) (3.35)", 2, true, false, "fixed-point", bdf2},
      {"midpoint", "implicit midpoint rule (3.26)", 2, false, false, "fixed-point", midpoint},
      {"imex-midpoint", "IMEX midpoint rule, ARS(1,2,2) (3.4.1)", 2, false, true, "linear", imex_midpoint},
      {"verlet", "velocity Verlet, explicit, sub-stepped inside its stability limit", 2, false, true, "none", verlet},
  };
  return table;
}

const Method& method(std::string_view name) { return find_named(methods(), "method", name); }

}  // namespace drape::solver
