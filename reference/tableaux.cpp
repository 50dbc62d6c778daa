#include "reference/tableaux.hpp"

#include <cmath>
#include <utility>

#include "solver/base/registry.hpp"

namespace drape::reference {
namespace {

using Part = Tableau::Part;

constexpr auto ars = "L-stable additive pair [Ascher, Ruuth, Spiteri 1997]";
constexpr auto kennedy = "L-stable [Kennedy, Carpenter 2016]";

Part named(std::string_view table) { return {table}; }
Part ours(std::vector<double> A, std::vector<double> b, std::vector<double> c) {
  return {{}, std::move(A), std::move(b), std::move(c)};
}

std::vector<Tableau> make_tableaux() {
  const double g = 1 - std::sqrt(0.5), d = 1 - 1 / (2 * g);  // of ARS(2,2,2)
  const std::vector<double> c222{0, g, 1}, c443{0, 0.5, 2. / 3, 0.5, 1};
  return {
      {"midpoint", "implicit midpoint rule", 2, ours({0.5}, {1}, {0.5})},
      {"sdirk-2", "SDIRK, L-stable", 2, named("ARKODE_SDIRK_2_1_2")},
      {"trbdf2", "TR-BDF2 [Bank et al. 1985]", 2, named("ARKODE_TRBDF2_3_3_2")},
      {"esdirk-3", kennedy, 3, named("ARKODE_ESDIRK325L2SA_5_2_3")},
      {"esdirk-4", kennedy, 4, named("ARKODE_ESDIRK436L2SA_6_3_4")},
      {"esdirk-5", kennedy, 5, named("ARKODE_ESDIRK547L2SA_7_4_5")},
      {"ars-111", "IMEX Euler rule", 1, ours({0, 0, 0, 1}, {0, 1}, {0, 1}), ours({0, 0, 1, 0}, {1, 0}, {0, 1})},
      {"ars-122", "IMEX midpoint rule", 2, ours({0, 0, 0, 0.5}, {0, 1}, {0, 0.5}), ours({0, 0, 0.5, 0}, {0, 1}, {0, 0.5})},
      {"ars-222", ars, 2, ours({0, 0, 0, 0, g, 0, 0, 1 - g, g}, {0, 1 - g, g}, c222),
       ours({0, 0, 0, g, 0, 0, d, 1 - d, 0}, {d, 1 - d, 0}, c222)},
      {"ars-443", ars, 3,
       ours({0, 0, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1. / 6, 0.5, 0, 0, 0, -0.5, 0.5, 0.5, 0, 0, 1.5, -1.5, 0.5, 0.5},
            {0, 1.5, -1.5, 0.5, 0.5}, c443),
       ours(
           {0, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 11. / 18, 1. / 18, 0, 0, 0, 5. / 6, -5. / 6, 0.5, 0, 0, 0.25, 1.75, 0.75, -1.75, 0},
           {0.25, 1.75, 0.75, -1.75, 0}, c443)},
      {"ark-4", "L-stable additive pair [Kennedy, Carpenter 2003]", 4, named("ARKODE_ARK436L2SA_DIRK_6_3_4"),
       named("ARKODE_ARK436L2SA_ERK_6_3_4")},
      {"bogacki-shampine", "[Bogacki, Shampine 1989]", 3, {}, named("ARKODE_BOGACKI_SHAMPINE_4_2_3")},
      {"knoth-wolke", "[Knoth, Wolke 1998]", 3, {}, named("ARKODE_KNOTH_WOLKE_3_3")},
      {"zonneveld", "[Zonneveld 1963]", 4, {}, named("ARKODE_ZONNEVELD_5_3_4")},
      {"dormand-prince", "[Dormand, Prince 1980]", 5, {}, named("ARKODE_DORMAND_PRINCE_7_4_5")},
      {"fehlberg-8", "[Fehlberg 1968]", 8, {}, named("ARKODE_FEHLBERG_13_7_8")},
  };
}

}  // namespace

std::span<const Tableau> tableaux() {
  static const std::vector<Tableau> table = make_tableaux();
  return table;
}

const Tableau& tableau(std::string_view name) { return base::find_named(tableaux(), "Runge-Kutta method of ARKODE", name); }

}  // namespace drape::reference
