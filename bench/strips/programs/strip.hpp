#pragma once

#include "bench/strips/share.hpp"
#include "model/cloth.hpp"

namespace drape::bench::strips {

/// The strip of a sheet that this process has, as an ODE whose partition is over all processes. Its particles are those of its
/// lines, between copies of the neighbours' next lines.
class Strip {
 public:
  /// Throws std::invalid_argument as shares() and strip_of() do. `lines`: as for shares().
  Strip(const model::Scene& whole, const std::vector<int>& lines);
  Strip(const Strip&) = delete;
  Strip& operator=(const Strip&) = delete;

  const solver::SplitOde& ode() const { return ode_; }
  const solver::State& start() const { return cloth_.start; }
  double begin() const { return cloth_.begin; }

  const Share& share() const { return share_; }
  int columns() const { return columns_; }  ///< particles of a line
  int lines() const { return lines_; }      ///< of the whole sheet

  /// The rows of own particles in fields of the ODE.
  Eigen::Index first_row() const { return static_cast<Eigen::Index>(columns_) * share_.before; }
  Eigen::Index rows() const { return static_cast<Eigen::Index>(columns_) * share_.lines; }

  /// Sets the copied lines of a field to what their owners have.
  void exchange(solver::Vectors& field) const;

  /// Sets a to M⁻¹ f(t, y) of own particles, 0 in the directions of pins, and the copied lines of y.
  void acceleration(double t, solver::State& y, solver::Vectors& a) const;

 private:
  Strip(const model::Scene& whole, const Share& share);

  solver::SplitOde::Force exchanged(solver::SplitOde::Force force) const;

  const Share share_;
  const int columns_, lines_;
  model::Cloth cloth_;
  solver::SplitOde ode_;
};

}  // namespace drape::bench::strips
