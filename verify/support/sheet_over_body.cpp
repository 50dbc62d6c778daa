#include "verify/support/sheet_over_body.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace drape::verify {

using Eigen::Vector3d;

model::TriangleMesh ball_mesh(double radius, int times) {
  model::TriangleMesh mesh{"the ball", {}, {}};
  constexpr double phi = std::numbers::phi;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-phi, phi})
      for (const Vector3d& v : {Vector3d(0, a, b), Vector3d(a, b, 0), Vector3d(b, 0, a)})
        mesh.vertices.push_back(v.normalized());
  const auto joined = [&](int i, int j) { return mesh.vertices[i].dot(mesh.vertices[j]) > 0.4; };
  for (int i = 0; i < 12; ++i)
    for (int j = i + 1; j < 12; ++j)
      for (int k = j + 1; k < 12; ++k)
        if (joined(i, j) && joined(j, k) && joined(k, i)) {
          const auto& v = mesh.vertices;
          mesh.triangles.push_back(v[i].cross(v[j]).dot(v[k]) > 0 ? std::array{i, j, k} : std::array{i, k, j});
        }
  for (int time = 0; time < times; ++time) {
    std::map<std::array<int, 2>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [found, is_new] =
          middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<int>(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
      return found->second;
    };
    std::vector<std::array<int, 3>> quarters;
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      quarters.insert(quarters.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles.swap(quarters);
  }
  for (Vector3d& vertex : mesh.vertices) vertex *= radius;
  return mesh;
}

TriangleSheet::TriangleSheet(int n) : x(n * n, 3) {
  for (int b = 0; b < n; ++b)
    for (int a = 0; a < n; ++a) {
      const int i = a + n * b;
      x.row(i) << 2.0 * a / (n - 1) - 1, 2.0 * b / (n - 1) - 1, 0;
      if (a + 1 == n || b + 1 == n) continue;
      faces.push_back({i, i + 1, i + n});
      faces.push_back({i + n + 1, i + n, i + 1});
    }
}

bool SheetOverBody::inside(const Vector3d& point) const {
  return std::ranges::all_of(body.triangles, [&](const std::array<int, 3>& triangle) {
    const model::Corners c = corners(body, triangle);
    return model::face_normal(c).dot(point - c[0]) < 0;
  });
}

SheetOverBody random_sheet_over_body(std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  std::uniform_int_distribution<int> particles(2, 5), shape(0, 1);
  while (true) {
    const int n = particles(random);
    SheetOverBody made{TriangleSheet(n), {}, Vector3d(0.6 * any(random), 0.6 * any(random), -0.15 + 0.15 * any(random))};
    for (int i = 0; i < n * n; ++i) {
      auto x = made.sheet.x.row(i);
      const double sag = 0.1 * x.squaredNorm();
      x += 0.1 / (n - 1) * Eigen::RowVector3d(any(random), any(random), any(random));
      x.z() -= sag;
    }
    const Vector3d size(0.4 + 0.2 * any(random), 0.4 + 0.2 * any(random), 0.3 + 0.2 * any(random));
    made.body = shape(random) == 0 ? box_mesh(size) : ball_mesh(0.3, 2);
    const Eigen::Quaterniond turned(Eigen::Vector4d(any(random), any(random), any(random), any(random)).normalized());
    for (Vector3d& vertex : made.body.vertices) vertex = made.centre + turned * vertex;
    if (std::ranges::none_of(made.sheet.x.rowwise(), [&](const auto& x) { return made.inside(x); })) return made;
  }
}

}  // namespace drape::verify
