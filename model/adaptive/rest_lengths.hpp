#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace drape::model {

/// Rest lengths r l_j / Σ l_i of the parts into which points divide an edge of rest length r [m] [Etzmuß 2002, 5.4], where l_j
/// are the distances between neighbours in `chain`: one end of the edge, the points in their order, the other end [m].
///
/// Added in order they are r to the last bit: all except the last are multiples of a power of 2 that r is as well, so that
/// none of the sums is rounded. For that they are off by at most the unit in the last place of 2r.
/// Throws std::invalid_argument unless some neighbours are apart.
std::vector<double> split_rest_length(double rest, std::span<const Eigen::Vector3d> chain);

}  // namespace drape::model
