#pragma once

#include <vector>

#include "solver/state.hpp"

namespace drape::solver {

/// The last accepted states, and the polynomials through them. Allocates with the first state only.
class History {
 public:
  static constexpr int most_points = 6;
  using Weights = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, most_points, 1>;

  /// `points`: how many are kept at most.
  explicit History(int points) : points_(points) {}

  /// Adds what is newer than all before.
  void push(double t, const State& y);

  /// Forgets all but the newest: the motion before was another one.
  void restart();

  int size() const { return size_; }
  bool full() const { return size_ == points_; }

  /// The k-th state back from the newest, which is 0, and its time.
  const State& state(int k) const { return kept_[k].y; }
  double time(int k) const { return kept_[k].t; }

  /// Weights of the polynomial through the newest `points` states at time t, newest first.
  Weights weights(double t, int points) const;

  /// Sets v, and x if it is not null, to the polynomial through all states.
  void extrapolate(double t, Vectors& v, Vectors* x = nullptr) const;

  /// For a smooth motion the extrapolation to t misses by its derivative of order size() times this [sᵏ].
  double remainder(double t) const;

 private:
  struct Point {
    double t;
    State y;
  };
  int points_, size_ = 0;
  std::vector<Point> kept_;  ///< the newest first
};

}  // namespace drape::solver
