#pragma once

#include <vector>

#include "solver/split_ode.hpp"

namespace drape::solver {

/// Removes the prescribed directions of some particles from a vector field: P = I − Σ c cᵀ  [Etzmuß 2002, (4.3)].
class Filter {
 public:
  /// The free directions of a particle.
  struct Block {
    int particle;
    Eigen::Matrix3d free;  ///< orthogonal projector
  };

  /// The pins whose particles still have free coordinates: the others have no entries in the filtered matrices.
  static Filter partial(const std::vector<Pin>& pins);

  void clear() { blocks_.clear(); }
  void add(int particle, const Eigen::Matrix3d& free) { blocks_.push_back({particle, free}); }
  bool empty() const { return blocks_.empty(); }
  const std::vector<Block>& blocks() const { return blocks_; }

  void operator()(Vectors& r) const {
    for (const Block& block : blocks_) r.row(block.particle) *= block.free;
  }

 private:
  std::vector<Block> blocks_;
};

/// For each particle the projector on the coordinates that its pin leaves free; empty if there are no pins.
std::vector<Eigen::Matrix3d> allowed_directions(const SplitOde& ode);

}  // namespace drape::solver
