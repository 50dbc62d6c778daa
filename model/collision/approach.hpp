#pragma once

#include <optional>

#include "model/collision/proximity.hpp"

namespace drape::model {

/// A distance [m] that counts as fallen to `distance`: by a ten thousandth more, and by 1e-12 m where that is 0.
inline double reached(double distance) { return distance * (1 + 1e-4) + 1e-12; }

/// The first part of a motion at which the distance of a pair falls to `distance` [m] or below, nothing if it never does.
/// Points move uniformly from x0 to x1.
///
/// Conservative advancement [Mirtich 1996]: all of the one lies on one side of the plane across the shortest way to the other,
/// and the next time is that at which a corner may have left its side. It is never later than the true one, and the distance
/// then is at most reached(distance), which motions that come as near also count as. Those that take more than 100 steps are
/// said to end where these have led, which is too early.
std::optional<double> first_approach(PairKind kind, const FourPoints& x0, const FourPoints& x1, double distance);

/// A pair that comes near in a step.
struct Approach {
  PairKind kind;
  Proximity begin;  ///< where the step begins
  Proximity touch;  ///< where the step ends if that is on the same side, else where the distance has fallen as far as was asked
  double part;      ///< of the step until the distance has fallen as far
};

/// The approach of points that move uniformly from x0 to x1, if their distance falls to `distance` [m] or below. Those that
/// begin nearer have part 0, and are none if they end farther apart and do not come nearer by a thousandth on the way. Two
/// edges have to be nearest inside both when they touch, unless one may end there: that of a chain.
std::optional<Approach> approach(PairKind kind, const std::array<int, 4>& particles, const Vectors& x0, const Vectors& x1,
                                 double distance, bool may_end);

/// Where the points of such a motion are at a part of it.
FourPoints points_between(const FourPoints& x0, const FourPoints& x1, double part);

}  // namespace drape::model
