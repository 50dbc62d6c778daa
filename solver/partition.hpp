#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <span>

#include "solver/state.hpp"

namespace drape::solver {

/// How processes share particles out, and what all parts of a step must agree on: sums over all particles.
///
/// The ODE of a process has its own particles, one after the other, between copies of those of its neighbours. A copy moves as
/// its original does, since its forces and the solutions of linear systems are set to those of the original; what methods make
/// of forces, masses and pins is the same for both. Sums are over the own particles of all processes, the same in each. This
/// class is that of an ODE that has all particles.
class Partition {
 public:
  Partition() = default;
  Partition(const Partition&) = delete;
  Partition& operator=(const Partition&) = delete;
  virtual ~Partition() = default;

  static const std::shared_ptr<const Partition>& of_one_process() {
    static const auto whole = std::make_shared<const Partition>();
    return whole;
  }

  /// Coordinates as they lie in memory.
  struct Range {
    Eigen::Index begin, count;
  };

  /// The coordinates of own particles, `all` being those of the ODE.
  virtual Range own(Eigen::Index all) const { return {0, all}; }

  /// Number of particles before those of the ODE, and of all.
  struct Place {
    Eigen::Index before, all;
  };

  /// The place of the ODE, which has this number of particles.
  virtual Place place(Eigen::Index particles) const { return {0, particles}; }

  /// Adds what the other processes have, in the order of these.
  virtual void add_up(std::span<double>) const {}

  /// The largest of what the processes have.
  virtual double largest(double here) const { return here; }

  /// Sets what a field has on copies to what it has on their originals.
  virtual void set_copies(Vectors&) const {}

  double sum(double here) const {
    add_up({&here, 1});
    return here;
  }

  bool any(bool here) const { return largest(here ? 1 : 0) > 0; }

  /// The own coordinates of a field.
  Eigen::Map<const Eigen::VectorXd> own(const Vectors& a) const {
    const Range range = own(a.size());
    return {a.data() + range.begin, range.count};
  }

  double norm(const Vectors& a) const { return std::sqrt(sum(own(a).squaredNorm())); }

  double largest_entry(const Vectors& a) const { return largest(own(a).cwiseAbs().maxCoeff()); }
};

}  // namespace drape::solver
