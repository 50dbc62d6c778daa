#pragma once

#include <vector>

#include "model/scene.hpp"

namespace drape::bench::strips {

/// The lines of a sheet that a process has: grid lines along the weft. Beside them it has copies of the next line of each
/// neighbour.
struct Share {
  int first;            ///< its first line
  int lines;            ///< their number
  bool before, behind;  ///< whether there is a neighbour

  int copied_first() const { return first - before; }
  int copied_lines() const { return lines + before + behind; }
};

/// Shares of this number of lines, of one process each. `wanted`: their lines; empty: as equal as possible. Throws
/// std::invalid_argument if a process would have none.
std::vector<Share> shares(int lines, int processes, const std::vector<int>& wanted = {});

/// A share of a sheet as a scene of its own, with the copied lines. Throws std::invalid_argument unless the scene is one
/// uniform sheet in one phase, without obstacles, whose forces are those of neighbours and weight: then forces on own particles
/// are those of the whole sheet.
model::Scene strip_of(const model::Scene& whole, const Share& share);

/// The masses of its particles, those on copied lines included, from those of the scene: borders of a strip are no borders of
/// the cloth [kg].
Eigen::VectorXd strip_masses(const model::Scene& whole, const Share& share, Eigen::VectorXd masses);

}  // namespace drape::bench::strips
