#include "model/obstacles/polygons.hpp"

#include <fmt/ostream.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace drape::model {

std::vector<std::array<int, 3>> fan_triangles(const Polygons& polygons) {
  std::vector<std::array<int, 3>> all;
  for (const std::vector<int>& face : polygons.faces)
    for (std::size_t k = 2; k < face.size(); ++k) all.push_back({face[0], face[k - 1], face[k]});
  return all;
}

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

Polygons ringed_sphere(int vertices) {
  using std::numbers::pi;
  const double side = std::sqrt(4 * pi / (vertices - 2) * 2 / std::numbers::sqrt3);
  const int rings = static_cast<int>(std::lround(pi / (side * std::numbers::sqrt3 / 2))) - 1;
  double circumference = 0;
  for (int r = 1; r <= rings; ++r) circumference += std::sin(pi * r / (rings + 1));
  Polygons sphere;
  sphere.vertices.emplace_back(0, 0, -1);
  std::vector<int> first{1};  // vertex of each ring, and the pole above
  double before = 0;
  for (int r = 1; r <= rings; ++r) {
    const double angle = pi * r / (rings + 1);
    before += std::sin(angle);
    const int end = 1 + static_cast<int>(std::lround((vertices - 2) * before / circumference)), count = end - first.back();
    for (int k = 0; k < count; ++k) {
      const double around = 2 * pi * (k + 0.5 * (r % 2)) / count;
      sphere.vertices.emplace_back(std::sin(angle) * std::cos(around), std::sin(angle) * std::sin(around), -std::cos(angle));
    }
    first.push_back(end);
  }
  sphere.vertices.emplace_back(0, 0, 1);
  const int last = first.back();
  for (int r = 0; r + 1 < rings; ++r) {
    const int lower = first[r], upper = first[r + 1], m = upper - lower, n = first[r + 2] - upper;
    const double shift = r % 2 == 0 ? -0.5 : 0.5;  // of the upper ring against the lower, in its own or the other's vertices
    for (int i = 0, j = 0; i + j < m + n;) {
      const double along_lower = (i + 1 + std::max(0.0, -shift)) / m, along_upper = (j + 1 + std::max(0.0, shift)) / n;
      const bool lower_next = j == n || (i < m && along_lower <= along_upper);
      if (lower_next)
        sphere.faces.push_back({lower + i % m, lower + (i + 1) % m, upper + j % n});
      else
        sphere.faces.push_back({lower + i % m, upper + (j + 1) % n, upper + j % n});
      ++(lower_next ? i : j);
    }
  }
  for (int k = 1; k < first[1]; ++k) sphere.faces.push_back({0, k + 1 < first[1] ? k + 1 : 1, k});
  for (int k = first[rings - 1]; k < last; ++k) sphere.faces.push_back({last, k, k + 1 < last ? k + 1 : first[rings - 1]});
  return sphere;
}

void write_obj(std::ostream& out, const Polygons& polygons) {
  for (const Eigen::Vector3d& v : polygons.vertices) fmt::print(out, "v {} {} {}\n", v[0], v[1], v[2]);
  for (std::vector<int> corners : polygons.faces) {
    for (int& corner : corners) ++corner;  // OBJ counts from 1
    fmt::print(out, "{} {}\n", corners.size() > 2 ? 'f' : 'l', fmt::join(corners, " "));
  }
}

}  // namespace drape::model
