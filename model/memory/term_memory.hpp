#pragma once

#include <cstdint>
#include <vector>

#include "solver/memory.hpp"

namespace drape::model {

/// What one force remembers: its part of solver::Memory, with its own variables alone.
class TermMemory {
 public:
  using Variables = Eigen::Ref<const Eigen::VectorXd>;
  using MutableVariables = Eigen::Ref<Eigen::VectorXd>;

  virtual ~TermMemory() = default;

  virtual int variables() const = 0;
  virtual void begin(int order, double t, const solver::State& y, const Variables& z) = 0;
  virtual void pass(double t, const solver::State& y, const Variables& z) = 0;
  virtual void carry(double t, const solver::State& y, MutableVariables z) = 0;
  virtual void rate(const solver::State& y, const Variables& z, MutableVariables dz) const = 0;
  virtual void respond(double gamma, const solver::State& y, const Variables& r, const solver::State& d,
                       MutableVariables dz) const = 0;
  virtual double energy(const solver::State& y, const Variables& z) const = 0;

  /// Adds its branches, if it has any.
  virtual void add_branches(const solver::State& /*y*/, const Variables& /*z*/, std::vector<int>& /*now*/) const {}
  virtual double first_kink(double /*h*/, double /*from*/, const solver::State& /*y0*/, const Variables& /*z*/,
                            const solver::State& /*y1*/) const {
    return 1;
  }

  /// How often its part of K has changed, and that part; the places of its entries never change.
  virtual std::int64_t stiffness_changes() const { return 0; }
  virtual void add_stiffness(std::vector<Eigen::Triplet<double>>& /*entries*/) const {}
};

}  // namespace drape::model
