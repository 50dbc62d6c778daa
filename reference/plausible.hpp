#pragma once

#include "reference/reference.hpp"

namespace drape::reference {

/// Whether a file with the right checksum can be the reference of a motion: its times, sizes and numbers fit, its
/// uncertainty is the distance of its two trajectories, pinned coordinates are where they move to, and a loose run of one of
/// our own methods from the start stays within 1e-3 of the size [m], times the growth of perturbations. With contact that run
/// ends at the first time; elsewhere after 2000 steps, or where it fails, since then it says nothing. Costs a small part of the
/// reference. Throws DamagedFile, saying what does not fit.
void require_plausible(const Reference& reference, const solver::SplitOde& ode, const solver::State& y0, double t0,
                       std::span<const double> times, double size);

}  // namespace drape::reference
