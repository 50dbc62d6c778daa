#pragma once

#include <vector>

#include "model/cloth.hpp"
#include "reference/exact/modes.hpp"
#include "solver/integrator.hpp"

namespace drape::verify {

/// A stretched sheet on which everything differs along u and along v.
reference::PinnedSheet tense_sheet();

/// The scene of a pinned sheet.
model::Scene scene_of(const reference::PinnedSheet& s);

/// The states at the start and after every one of n steps.
std::vector<solver::State> run(const model::Cloth& cloth, const solver::Method& method, double h, int n);

double energy(const solver::SplitOde& ode, const solver::State& y);

std::vector<double> energies(const model::Cloth& cloth, const solver::Method& method, double h, int n);

}  // namespace drape::verify
