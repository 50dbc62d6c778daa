#pragma once

#include "bench/peers/problem.hpp"
#include "model/cloth.hpp"

namespace drape::bench::peers {

/// Sets in a problem all that a simulator of springs needs of a scene: masses, start, pins that hold, weight and springs.
/// Throws std::invalid_argument, naming what is not like that, if the scene is anything else: its force at a displaced state is
/// compared with that of the springs.
void set_springs(Problem& problem, const model::Scene& scene, const model::Cloth& cloth);

/// The same for a simulator that has a cloth of its own: a membrane of the tension of the scene, without any of its other
/// elastic forces and without damping, in triangles of which each cell has two.
void set_membrane(Problem& problem, const model::Scene& scene, const model::Cloth& cloth);

/// The force of the springs and the weight of a problem on its particles [N], N × 3: what simulators are to compute.
solver::Vectors spring_force(const Problem& problem, const solver::Vectors& x, const solver::Vectors& v);

}  // namespace drape::bench::peers
