#pragma once

#include <span>
#include <vector>

#include "model/forces/term.hpp"
#include "model/sheet/metric.hpp"

namespace drape::model {

/// Adds the matrix of the force −∇(½ w |Σ c x|²).
void add_quadratic(std::vector<Eigen::Triplet<double>>& entries, std::span<const StencilEntry> stencil, double weight);

/// The elastic operator B on positions and the viscous one on velocities; both scalar, N × N, [N/m] and [N s/m].
struct LinearOperators {
  SparseMatrix elastic, viscous;
};

/// The force B x + B_d v in all directions.
Term unprojected(LinearOperators operators);

/// The force <B x + B_d v, N> N along the vertex normals, less its elastic part at rest. `rest`: positions; empty: flat.
Term projected(const Grid& grid, LinearOperators operators, const Vectors& rest);

}  // namespace drape::model
