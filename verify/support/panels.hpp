#pragma once

#include <numbers>

#include "model/sheet/grid.hpp"

/// A quarter of an annulus, with n × n particles: u along the radius, v along the circles.
namespace drape::verify::panels {

constexpr double inner = 0.2, outer = 0.5;  ///< radii [m]

inline model::Grid sector(int n) {
  using enum model::CurvePiece::Kind;
  const auto quarter = [](double r) {
    const double c = r * std::numbers::sqrt2 / 2;
    return std::vector<model::CurvePiece>{{arc, {{r, 0}, {c, c}, {0, r}}}};
  };
  model::Grid grid{n, n, outer, outer};
  grid.outline = {.lower = {{line, {{inner, 0}, {outer, 0}}}},
                  .upper = {{line, {{0, inner}, {0, outer}}}},
                  .left = quarter(inner),
                  .right = quarter(outer)};
  return grid;
}

}  // namespace drape::verify::panels
