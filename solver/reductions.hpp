#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <span>

#include "solver/state.hpp"

namespace drape::solver {

/// Sums over all particles, which all parts of a step must agree on.
///
/// Processes may share the particles out. Then the ODE of each has its own, one after the other, between copies of those of
/// neighbours, whose forces it receives; a sum is that over the own ones of all processes, the same on each. This class is that
/// of an ODE that has all particles.
class Reductions {
 public:
  Reductions() = default;
  Reductions(const Reductions&) = delete;
  Reductions& operator=(const Reductions&) = delete;
  virtual ~Reductions() = default;

  static const std::shared_ptr<const Reductions>& of_one_process() {
    static const auto whole = std::make_shared<const Reductions>();
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
