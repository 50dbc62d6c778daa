#pragma once

#include <vector>

#include "solver/state.hpp"

namespace drape::solver {

/// A state on the trajectory with the force that the method keeps: f_expl for IMEX methods, the whole force for `verlet`.
struct Point {
  double t = 0;  ///< [s]
  State y;
  Vectors f;  ///< N × 3, or empty if the method keeps none
  bool has_f = false;
};

/// The last accepted points, and the polynomials through their states.
class History {
 public:
  static constexpr int most_points = 6;
  using Weights = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, most_points, 1>;

  /// Begins with the first point. `points`: the largest number that is kept; `forces`: the number of these with `f`, which has
  /// the size of the first's.
  History(int points, int forces, const Point& first);

  /// Adds `next`, a step of h [s] after the newest point, and leaves in it the memory for another one.
  void push(Point& next, double h);

  /// Discards all points except the newest.
  void restart();

  /// Makes later extrapolations begin with the newest point, where the motion was not smooth.
  void begin_smooth() { smooth_ = 1; }

  /// Number of points for multistep methods.
  int size() const { return size_; }

  /// Number of these on a smooth motion, for extrapolations.
  int smooth() const { return smooth_; }
  bool full() const { return smooth_ == points_; }

  /// Point k, counted from the newest, which is 0.
  Point& operator[](int k) { return kept_[k]; }
  const Point& operator[](int k) const { return kept_[k]; }

  /// The step that led to the newest point [s]; 0 if the motion began there.
  double last_step() const { return last_step_; }

  /// Weights of the polynomial through the newest `points` states at time t, newest first.
  Weights weights(double t, int points) const;

  /// Sets v, and x if it is not null, to the polynomial through all states of the smooth motion.
  void extrapolate(double t, Vectors& v, Vectors* x = nullptr) const;

  /// The error of the extrapolation to t, over the motion's derivative of order k = smooth() [sᵏ].
  double remainder(double t) const;

 private:
  int points_, forces_, size_ = 1, smooth_ = 1;
  double last_step_ = 0;
  std::vector<Point> kept_;  ///< the newest first
};

}  // namespace drape::solver
