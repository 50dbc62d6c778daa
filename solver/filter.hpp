#pragma once

#include <map>
#include <vector>

#include "solver/split_ode.hpp"

namespace drape::solver {

/// An orthogonal projector that couples particles.
class Projector {
 public:
  virtual ~Projector() = default;
  virtual void project(Vectors& r) const = 0;
};

/// Removes the prescribed directions of some particles from a vector field, P = I − Σ c cᵀ  [Etzmuß 2002, (4.3)], and then what
/// a projector does.
class Filter {
 public:
  /// The free directions of a particle.
  struct Block {
    int particle;
    Eigen::Matrix3d free;  ///< orthogonal projector
  };

  /// The pins whose particles still have free directions: the others have no entries in the filtered matrices.
  static Filter partial(const std::vector<Pin>& pins);

  void clear() {
    blocks_.clear();
    projector_ = nullptr;
  }
  void add(int particle, const Eigen::Matrix3d& free) { blocks_.push_back({particle, free}); }
  void add(const Projector& projector) { projector_ = &projector; }
  bool empty() const { return blocks_.empty() && projector_ == nullptr; }
  const std::vector<Block>& blocks() const { return blocks_; }

  void operator()(Vectors& r) const;

 private:
  std::vector<Block> blocks_;
  const Projector* projector_ = nullptr;
};

/// The free directions of particles that are pinned along others than axes. Other pins set coordinates to zero, in matrices and
/// in vectors; these take more.
class ObliquePins {
 public:
  explicit ObliquePins(const std::vector<Pin>& pins);

  bool empty() const { return free_.empty(); }

  /// What particle i has of a vector in its free directions.
  Eigen::Vector3d filtered(int i, const Eigen::Vector3d& a) const;

  /// The same of a block of a matrix: row particle i, column particle j.
  Eigen::Matrix3d filtered(int i, int j, const Eigen::Matrix3d& block) const;

  void operator()(Vectors& r) const;

  /// The projector on free directions, 3N × 3N.
  SparseMatrix matrix(int particles) const;

 private:
  std::map<int, Eigen::Matrix3d> free_;
};

/// For each particle the projector on the directions that its pin leaves free; empty if there are no pins.
std::vector<Eigen::Matrix3d> allowed_directions(const SplitOde& ode);

}  // namespace drape::solver
