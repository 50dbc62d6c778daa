#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace drape::reference {

/// A Runge-Kutta method for ARKODE with constant steps: implicit, explicit, or both (additive) on the split of the thesis.
/// Each part is one of ARKODE's own tables, by its name there, or has coefficients of ours.
struct Tableau {
  std::string_view name;
  std::string_view description;
  int order;

  struct Part {
    std::string_view table = {};                 ///< of ARKODE
    std::vector<double> A = {}, b = {}, c = {};  ///< or ours; A row by row, stages²

    explicit operator bool() const { return !table.empty() || !b.empty(); }
  };
  Part implicit, explicit_part = {};

  bool solves_systems() const { return static_cast<bool>(implicit); }
};

/// All of them.
std::span<const Tableau> tableaux();

/// The one with this name. Throws std::invalid_argument, naming all that there are.
const Tableau& tableau(std::string_view name);

}  // namespace drape::reference
