#pragma once

#include <cstdint>
#include <vector>

#include "model/adaptive/body_surface.hpp"
#include "model/adaptive/virtual_neighbours.hpp"
#include "model/adaptive/virtual_particles.hpp"
#include "model/forces/term.hpp"
#include "solver/split_ode.hpp"

namespace drape::model {

/// The springs that obstacles divide, as forces of a step: what virtual neighbours pull less the pull of the whole springs, of
/// tension and its damping. [Etzmuß 2002, 5.4]
///
/// Virtual particles are found at the beginning of a step and move with the obstacle until it ends. No force acts on them: what
/// they pull is what the obstacle exerts. In the split equation K and D take k w/r_j and d w/r_j of each end, r_j being the
/// rest length of its part, and lose the coupling of the ends: constant matrices bound the stiffest parts, however short.
class AdaptiveSprings : public solver::StepForces {
 public:
  /// `faces`, `places`: of VirtualParticles; `ode`: with K and D of the undivided sheet. Throws as VirtualParticles does.
  AdaptiveSprings(const Sheet& sheet, std::span<const std::array<int, 3>> faces, const Vectors& places, BodySurface obstacles,
                  const solver::SplitOde& ode);

  void begin(double t, const solver::State& y) override;
  std::int64_t changes() const override { return changes_; }
  const SparseMatrix& stiffness() const override { return stiffness_; }
  const SparseMatrix& damping() const override { return damping_; }
  void of_obstacles(Part part, double t, const solver::State& y, Vectors& f) const override;
  double energy(double t, const Vectors& x) const override;

  /// Adds the forces to f (N × 3) [N], all of them or what is not in K x + D v.
  void add(double t, const Vectors& x, const Vectors& v, Vectors& f) const { add(Part::whole, t, x, v, f); }
  void add_explicit(double t, const Vectors& x, const Vectors& v, Vectors& f) const { add(Part::without_linear, t, x, v, f); }

  /// Adds blocks of all springs, 0 for those that are not divided, so that their order is always the same.
  void visit(double t, const Vectors& x, const Vectors& v, const JacobianEntries& entries) const;

 private:
  /// A spring, or a part of one.
  struct Strand {
    double k, d;    ///< moduli times width [N], [N s]
    double length;  ///< at rest [m]
  };

  /// A part between a node and its virtual neighbour.
  struct End {
    int node;
    Strand strand;              ///< its length may be 0: then the node is at the obstacle, and nothing pulls
    Eigen::Vector3d at, moves;  ///< of the virtual particle when the step begins [m], [m/s]

    Eigen::Vector3d place(double after) const { return at + after * moves; }
  };

  struct Spring {
    EdgeEnds ends;
    Strand strand;
    int first = -1;  ///< of its two parts, from i and from j; −1: it is not divided
  };

  Strand strand(const Edge& edge, double length) const;
  void divide(const DividedSpring& divided);
  void set_matrices();
  void add(Part part, double t, const Vectors& x, const Vectors& v, Vectors& f) const;
  Eigen::Vector3d pull(const Strand& strand, Part part, const Eigen::Vector3d& d, const Eigen::Vector3d& u) const;
  Eigen::Vector3d pull(const End& end, Part part, double t, const Vectors& x, const Vectors& v) const;

  BodySurface obstacles_;
  VirtualParticles search_;
  VirtualNeighbours neighbours_;
  WeftWarp k_, d_;
  bool projected_;  ///< whether damping is along the springs
  std::vector<Edge> edges_;
  std::vector<Spring> springs_;  ///< aligned with the edges
  std::vector<int> divided_;
  std::vector<End> ends_;                         ///< two for each divided spring
  SparseMatrix whole_stiffness_, whole_damping_;  ///< K and D of the sheet
  SparseMatrix stiffness_, damping_;              ///< and of now
  double t_ = 0;                                  ///< when the step begins [s]
  Vectors x_;                                     ///< then; empty before the first step
  std::vector<Eigen::Vector3d> positions_, velocities_;
  std::int64_t changes_ = 0;
  std::int64_t &searches_, &divided_springs_;
};

}  // namespace drape::model
