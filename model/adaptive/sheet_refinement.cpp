#include "model/adaptive/sheet_refinement.hpp"

#include "model/collision/cloth_surface.hpp"

namespace drape::model {

SheetRefinement::SheetRefinement(const Garment& garment, std::span<const ObstacleRule> obstacles)
    : work_(std::make_unique<solver::Counters>()),
      obstacles_(obstacles),
      sheet_("the sheet", ClothSurface(garment).triangles()) {
  if (obstacles_.empty()) return;
  search_ = std::make_unique<VirtualParticles>(sheet_.triangles(), garment.start().x, obstacles_.mesh(), *work_);
}

RefinedSheet SheetRefinement::at(double t, const Vectors& x) {
  obstacles_.place(t, vertices_, velocities_);
  return refine(sheet_, x, search_ ? search_->find(x, vertices_) : Insertion{});
}

Polygons SheetRefinement::polygons(double t, const Vectors& x) {
  const RefinedSheet refined = at(t, x);
  Polygons all;
  for (Eigen::Index i = 0; i < x.rows(); ++i) all.vertices.emplace_back(x.row(i));
  for (const VirtualParticle& particle : refined.particles) all.vertices.push_back(particle.position);
  for (const auto& [a, b, c] : refined.triangles) all.faces.push_back({a, b, c});
  return all;
}

void require_bodies(const Scene& scene) {
  if (scene.contact.adaptive) const BodySurface bodies(scene.obstacles);
  if (scene.contact.detection == DetectionKind::ray) met_parts(scene.obstacles, scene.contact);
}

}  // namespace drape::model
