#include "model/clear_cloth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "model/collision/self_contacts.hpp"
#include "model/phases.hpp"
#include "model/sheet/cells.hpp"

namespace drape::model {
namespace {

/// "cell [3, 4] of panel 'front'"; `particle`: its first one.
std::string cloth_place(std::string_view what, const Garment::Panel& panel, int particle) {
  const int nu = panel.sheet.grid.nu;
  const std::string place = fmt::format("{} [{}, {}]", what, particle % nu, particle / nu);
  return panel.name.empty() ? place : fmt::format("{} of panel '{}'", place, panel.name);
}

/// The cell that has all corners of a face.
std::string cell_of(const Garment& garment, const ClothSurface::Face& face) {
  for (const Garment::Panel& panel : garment.panels())
    for (const Cell& cell : cells(panel.sheet.grid)) {
      const auto is_corner = [&](int node) {
        return std::ranges::any_of(
            cell.corner, [&](const auto& side) { return panel.node(side[0]) == node || panel.node(side[1]) == node; });
      };
      if (std::ranges::all_of(face.corners, is_corner)) return cloth_place("cell", panel, cell.corner[0][0]);
    }
  return "an edge of a chain";
}

std::string particle_at(const Garment& garment, int node) {
  for (const Garment::Panel& panel : garment.panels())
    for (int i = 0; i < panel.sheet.grid.particles(); ++i)
      if (panel.node(i) == node) return cloth_place("particle", panel, i);
  return "a particle";
}

/// A face and its smallest altitude [m].
struct Flattest {
  int face = 0;
  double altitude = std::numeric_limits<double>::infinity();
};

Flattest flattest(const ClothSurface& surface, const Vectors& x) {
  Flattest least;
  for (int k = 0; k < std::ssize(surface.faces()); ++k) {
    if (surface.faces()[static_cast<std::size_t>(k)].is_edge()) continue;
    const auto [a, b, c] = surface.corners(k, x);
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const double altitude = (b - a).cross(c - a).norm() / longest;
    if (altitude < least.altitude) least = {k, altitude};
  }
  return least;
}

}  // namespace

void require_clear_cloth(const Scene& scene) {
  const double thickness = scene.contact.thickness;
  if (thickness == 0) return;
  const Garment garment(phases(scene).front());
  const Vectors x = garment.start().x;
  solver::Counters unused;
  SelfContacts contacts(ClothSurface(garment), unused);
  const auto cell = [&](int face) { return cell_of(garment, contacts.surface().faces()[static_cast<std::size_t>(face)]); };
  const Flattest least = flattest(contacts.surface(), x);
  if (thickness > least.altitude / 2)
    throw std::invalid_argument(
        fmt::format("contact.thickness = {:g}: expected at most half of the smallest altitude of triangles, {:.3g} m in {}",
                    thickness, least.altitude / 2, cell(least.face)));
  if (const auto through = contacts.intersections(x); !through.empty())
    throw std::invalid_argument(fmt::format("expected cloth that does not begin through itself, as {} and {} do",
                                            cell(through.front()[0]), cell(through.front()[1])));
  constexpr double round_off = 1e-9;
  std::vector<Proximity> near;
  contacts.near(x, (1 - round_off) * thickness, near);
  if (near.empty()) return;
  const Proximity& nearest = *std::ranges::min_element(near, {}, &Proximity::distance);
  throw std::invalid_argument(fmt::format(
      "expected cloth to begin at least contact.thickness = {:g} m from itself, not {:.3g} m as {} and {} do", thickness,
      nearest.distance, particle_at(garment, nearest.particles[0]), particle_at(garment, nearest.particles[2])));
}

}  // namespace drape::model
