#pragma once

#include <array>
#include <span>
#include <vector>

#include "solver/base/disjoint_sets.hpp"
#include "solver/contact/pair_motion.hpp"
#include "solver/contact/pair_search.hpp"
#include "solver/split_ode.hpp"

namespace drape::solver {

/// Keeps a cloth apart from itself after a step, whatever method has taken it: pairs that meet on the way are pushed apart by
/// inelastic impulses, one after the other [Bridson, Fedkiw, Anderson 2002]; what still meets then moves as one rigid body
/// [Provot 1997]. Both keep momentum where nothing is pinned; impulses keep angular momentum, rigid motion does to the second
/// order of the angle.
class Separation {
 public:
  explicit Separation(const SplitOde& ode);

  /// Parts of the distances that pairs keep.
  struct Distances {
    double wanted;  ///< by impulses as far as some rounds of them do it
    double least;
  };

  /// Changes y1, at t + h, so that no pair comes nearer than the least distance on straight ways from y0, or nearer than it
  /// began, and no particle goes deeper into the half-spaces of these contacts. False if that is not possible, as where pins
  /// force pairs through each other.
  bool separate(double t, const State& y0, double h, const Distances& distances, std::span<const Contact> contacts, State& y1);

 private:
  /// What impulses along the motion of a pair do.
  struct Push {
    ClothPart cloth;
    PairContact::Points points;                              ///< without weights of bodies
    double friction;                                         ///< μ
    double aim;                                              ///< distance that is wanted, without what bodies are of it [m]
    PairMotion motion;                                       ///< the impulses
    Eigen::Vector3d before;                                  ///< what it gives of positions before the step [m]
    std::array<std::array<Eigen::Vector3d, 4>, 3> way = {};  ///< of the particles for a unit of impulse
    Eigen::Vector3d gain = Eigen::Vector3d::Zero();          ///< change of the motion
    double free = 0;                                         ///< the same where impulses have a torque
    Eigen::Vector3d given = Eigen::Vector3d::Zero();         ///< impulses

    double give(int direction, double impulse, Vectors& x);
    double push(Vectors& x);
    void rub(Vectors& x);
  };

  Push push_of(const PairContact& pair, double part, const Vectors& x0, const Vectors& arms) const;
  void bound(std::span<const Contact> contacts, const Vectors& x1);
  void push_apart(const Vectors& x0, const Vectors& arms, double part, Vectors& x1);
  void push_out(Vectors& x1);
  void move_rigidly(const Vectors& x0, Vectors& x1);

  /// A half-space, in which a particle has been pushed by so far.
  struct Bound {
    int particle;
    Eigen::Vector3d normal;
    double least;      ///< <x, n> [m]
    double given = 0;  ///< [m]
  };

  const SplitOde& ode_;
  std::vector<double> lightness_;  ///< 1/m of each particle, 0 of those that are pinned [1/kg]
  std::vector<PairContact> found_;
  std::vector<Push> pushes_;
  std::vector<Bound> bounds_;
  base::DisjointSets joined_;  ///< particles that move as one body
  Vectors x1_, arms_;
  std::int64_t &pushed_, &rigid_;
};

}  // namespace drape::solver
