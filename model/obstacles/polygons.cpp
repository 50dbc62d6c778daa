#include "model/obstacles/polygons.hpp"

#include <fmt/ostream.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace drape::model {

Polygons square(double side) {
  const double a = side / 2;
  return {{{-a, -a, 0}, {a, -a, 0}, {a, a, 0}, {-a, a, 0}}, {{0, 1, 2, 3}}};
}

Polygons turned(const std::vector<ProfilePoint>& profile) {
  constexpr int sides = 48;
  Polygons polygons;
  for (const auto& [r, z] : profile)
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      polygons.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  const int last = static_cast<int>(polygons.vertices.size()) - sides;
  for (int ring = 0; ring < last; ring += sides)
    for (int k = 0; k < sides; ++k) {
      const int next = (k + 1) % sides;
      polygons.faces.push_back({ring + k, ring + next, ring + sides + next, ring + sides + k});
    }
  std::vector<int> lid(sides);
  std::iota(lid.begin(), lid.end(), last);
  polygons.faces.push_back(lid);
  std::iota(lid.rbegin(), lid.rend(), 0);
  polygons.faces.push_back(lid);
  return polygons;
}

void write_obj(std::ostream& out, const Polygons& polygons) {
  for (const Eigen::Vector3d& v : polygons.vertices) fmt::print(out, "v {} {} {}\n", v[0], v[1], v[2]);
  for (std::vector<int> corners : polygons.faces) {
    for (int& corner : corners) ++corner;  // OBJ counts from 1
    fmt::print(out, "{} {}\n", corners.size() > 2 ? 'f' : 'l', fmt::join(corners, " "));
  }
}

}  // namespace drape::model
