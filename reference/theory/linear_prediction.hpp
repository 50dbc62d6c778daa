#pragma once

#include <optional>

#include "reference/theory/amplification.hpp"

namespace drape::reference {

/// What linear theory says of a method on a sheet.
struct LinearPrediction {
  double radius;  ///< largest modulus of an amplification factor over the sheet's modes
  double loop;    ///< largest factor by which an update of the thesis' loop multiplies an error; 0: there is no loop
};

/// The prediction for a sheet of the numerical stiffness ν_h with the damping h k/d (infinite: none), over the modes that the
/// constant matrix knows, ν ≤ 8 ν_h, whose true stiffness is any part of that: all of it in plane, next to nothing
/// transversally.
///
/// From the characteristic polynomials of amplification.hpp, that of BDF(k) for k = 3, 4, 5. One-step methods that are A-stable
/// by construction have no growing modes, nor have methods that divide their steps: their radius is given as 1. Nothing for a
/// method without a theory.
std::optional<LinearPrediction> predict(const solver::Method& method, double stiffness, double stiffness_to_damping);

}  // namespace drape::reference
