#pragma once

#include <vector>

#include "solver/state.hpp"

namespace drape::solver {

/// A state on the trajectory with what a method keeps of it: f_expl for the IMEX methods, the whole force for `verlet`.
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

  /// Begins with the first point. `points`: how many are kept at most; `forces`: how many of these with `f`, which has the size
  /// of the first's.
  History(int points, int forces, const Point& first);

  /// Adds `next`, which is newer than all before and a step of h [s] from the newest, and leaves memory for another in its
  /// place.
  void push(Point& next, double h);

  /// Forgets all but the newest point: the motion before was another one.
  void restart();

  /// Lets extrapolations begin with the newest point: there the motion was not smooth.
  void begin_smooth() { smooth_ = 1; }

  /// The points that multistep methods may use.
  int size() const { return size_; }

  /// Those of them that lie on a smooth motion.
  int smooth() const { return smooth_; }
  bool full() const { return smooth_ == points_; }

  /// The k-th point back from the newest, which is 0.
  Point& operator[](int k) { return kept_[k]; }
  const Point& operator[](int k) const { return kept_[k]; }

  /// The step that led to the newest point [s]; 0 if the motion began there.
  double last_step() const { return last_step_; }

  /// Weights of the polynomial through the newest `points` states at time t, newest first.
  Weights weights(double t, int points) const;

  /// Sets v, and x if it is not null, to the polynomial through all states of the smooth motion.
  void extrapolate(double t, Vectors& v, Vectors* x = nullptr) const;

  /// The extrapolation of a smooth motion to t misses by its derivative of order smooth() times this [sᵏ].
  double remainder(double t) const;

 private:
  int points_, forces_, size_ = 1, smooth_ = 1;
  double last_step_ = 0;
  std::vector<Point> kept_;  ///< the newest first
};

}  // namespace drape::solver
