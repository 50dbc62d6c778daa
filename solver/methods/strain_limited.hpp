#pragma once

#include <span>

#include "solver/filter.hpp"
#include "solver/split_ode.hpp"

namespace drape::solver {

/// The strain that `strain-limited` allows   [Provot 1995].
constexpr double most_strain = 0.1;

/// Moves the ends of distances that are longer than 1 + most_strain times their rest length, one after the other and weighted
/// by their inverse masses, until these are as long as that; right angles are left. Returns whether any was longer.
bool limit_strain(std::span<const CompliantConstraint> constraints, const Vectors& inverse_masses, const ObliquePins& pins,
                  Vectors& x);

}  // namespace drape::solver
