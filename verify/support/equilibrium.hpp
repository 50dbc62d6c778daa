#pragma once

#include "model/cloth.hpp"

namespace drape::verify {

/// The equilibrium of the masses and springs of a scene near x, by Newton's method with the exact Jacobian, damped by the
/// natural monotonicity test [Deuflhard 2004, 3.1.4]: a step is halved until the next one, with the same Jacobian, would be
/// smaller; that does not mind how stiff the springs are. Throws std::runtime_error if it does not converge.
solver::Vectors equilibrium(const model::Scene& scene, solver::Vectors x);

/// L2 norm of the distance [m] over that of 1: the root mean square at the nodes, weighted with their dual cells.
double rms_distance(const model::Grid& grid, const solver::Vectors& a, const solver::Vectors& b);

}  // namespace drape::verify
