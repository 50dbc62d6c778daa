#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "model/term.hpp"
#include "solver/split_ode.hpp"

namespace drape::model {

/// Prescribes the motion of some particles.
struct PinRule {
  std::string where;                           ///< a name from `pin_places()`, or empty
  std::vector<std::pair<int, int>> particles;  ///< (a, b) along u and v, if `where` is empty
  std::array<bool, 3> directions{true, true, true};
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]
};

enum class Plane { horizontal, vertical };  ///< u along x; v along y or along z

/// Where and how the sheet begins: flat, stretched, moving as a whole.
struct Start {
  Plane plane = Plane::horizontal;
  WeftWarp stretch{1, 1};
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]
};

/// A scene as people describe it. A value: copy it, change it, compile it.
struct Scene {
  std::string name;
  std::string description;
  Sheet sheet;
  std::vector<PinRule> pins;
  Start start;
  double end = 1;  ///< [s]
};

/// The names that `PinRule::where` knows.
const std::vector<std::string>& pin_places();

/// The pins of a scene, at most one for a particle. Later rules win where directions overlap.
std::vector<solver::Pin> pins(const Scene& scene);

/// The state at t = 0 without prescribed velocities.
solver::State start(const Scene& scene);

/// Length by which errors are divided: the longer side [m].
double size(const Scene& scene);

/// Numerical stiffness ν_h = h² k/(ρ l²), the larger of weft and warp [Etzmuß 2002, 3.4.4].
double numerical_stiffness(const Scene& scene, double h);

/// h k/d, the larger of weft and warp; infinite without damping, 0 without tension.
double stiffness_to_damping(const Scene& scene, double h);

}  // namespace drape::model
