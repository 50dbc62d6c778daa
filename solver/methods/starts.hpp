#pragma once

#include "solver/step.hpp"

namespace drape::solver {

// Methods with which others begin.
void imex_euler(Step& s);
void implicit_euler(Step& s);
void midpoint(Step& s);
void imex_midpoint(Step& s);
void esdirk4(Step& s);

/// Coefficients of BDF(2) and SBDF(2) for steps that change by the factor w  [Etzmuß 2002, after (3.28)].
struct Bdf2Coefficients {
  double c1, c2, c3;
};
constexpr Bdf2Coefficients bdf2_coefficients(double w) {
  return {(1 + w) * (1 + w) / (1 + 2 * w), w * w / (1 + 2 * w), (1 + w) / (1 + 2 * w)};
}

/// c in the error c h³ d³y/dt³ of a step of BDF(2).
constexpr double bdf2_error(double w) { return (1 + w) * (1 + w) / (6 * w * (1 + 2 * w)); }

}  // namespace drape::solver
