#include "model/adaptive/refined_sheet.hpp"

#include "model/adaptive/face_triangulation.hpp"

namespace drape::model {

Eigen::Vector3d RefinedSheet::position(int number, const solver::Vectors& x) const {
  const int nodes = static_cast<int>(x.rows());
  return number < nodes ? Eigen::Vector3d(x.row(number)) : particles[number - nodes].position;
}

RefinedSheet refine(const EdgeMesh& sheet, const solver::Vectors& x, const Insertion& insertion) {
  RefinedSheet refined{insertion.particles, {}, {}};
  const auto position = [&](int number) { return refined.position(number, x); };
  const auto add = [&](const VirtualParticle& particle) {
    refined.particles.push_back(particle);
    return static_cast<int>(x.rows() + std::ssize(refined.particles)) - 1;
  };
  auto hit = insertion.faces.begin();
  for (int face = 0; face < std::ssize(sheet.triangles()); ++face) {
    const auto& nodes = sheet.triangles()[face];
    std::vector<std::array<int, 3>> parts{nodes};
    if (hit != insertion.faces.end() && hit->face == face)
      parts = triangulate({nodes, {position(nodes[0]), position(nodes[1]), position(nodes[2])}}, *hit++, position, add);
    refined.triangles.insert(refined.triangles.end(), parts.begin(), parts.end());
    refined.parents.insert(refined.parents.end(), parts.size(), face);
  }
  return refined;
}

}  // namespace drape::model
