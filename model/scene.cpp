#include "model/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string_view>
#include <tuple>

#include "model/obstacles/mesh_shape.hpp"
#include "model/sheet/edges.hpp"
#include "solver/base/registry.hpp"

namespace drape::model {
namespace {

using Place = bool (*)(const Grid& grid, int a, int b);

struct NamedPlace {
  std::string_view name;
  Place contains;
};

constexpr auto left = [](const Grid&, int a, int) { return a == 0; };
constexpr auto right = [](const Grid& grid, int a, int) { return a == grid.nu - 1; };
constexpr auto lower = [](const Grid&, int, int b) { return b == 0; };
constexpr auto upper = [](const Grid& grid, int, int b) { return b == grid.nv - 1; };

constexpr NamedPlace places[] = {
    {"left edge", left},
    {"right edge", right},
    {"lower edge", lower},
    {"upper edge", upper},
    {"border", [](const Grid& g, int a, int b) { return left(g, a, b) || right(g, a, b) || lower(g, a, b) || upper(g, a, b); }},
    {"corners",
     [](const Grid& g, int a, int b) { return (left(g, a, b) || right(g, a, b)) && (lower(g, a, b) || upper(g, a, b)); }},
    {"upper corners", [](const Grid& g, int a, int b) { return (left(g, a, b) || right(g, a, b)) && upper(g, a, b); }},
    {"all", [](const Grid&, int, int) { return true; }},
};

/// Bends all lines along u, which are straight, into waves along z whose chords are as long as their edges are.
void pleat(const Pleats& pleats, const Grid& grid, solver::Vectors& x) {
  const double l = x(1, 0) - x(0, 0), steepest = pleats.degrees * std::numbers::pi / 180;
  for (int a = 1; a < grid.nu; ++a) {
    const double theta = steepest * std::sin(2 * std::numbers::pi * pleats.count * (a - 0.5) / (grid.nu - 1));
    for (int b = 0; b < grid.nv; ++b) {
      const int i = grid.index(a, b);
      x(i, 0) = x(i - 1, 0) + l * std::cos(theta);
      x(i, 2) = x(i - 1, 2) + l * std::sin(theta);
    }
  }
}

}  // namespace

const std::vector<std::string>& pin_places() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const NamedPlace& place : places) all.emplace_back(place.name);
    return all;
  }();
  return names;
}

std::vector<int> pinned_particles(const Grid& grid, const PinRule& rule) {
  std::vector<int> found;
  for (const auto& [a, b] : rule.particles) found.push_back(grid.index(a, b));
  if (const double radius = rule.circle[2]; radius > 0) {
    const Vectors pattern = grid.parameters();
    for (int i = 0; i < grid.particles(); ++i)
      if ((pattern.row(i).head<2>() - rule.circle.head<2>().transpose()).norm() <= radius) found.push_back(i);
  }
  if (rule.where.empty()) return found;
  const NamedPlace& place = base::find_named<NamedPlace>(places, "place", rule.where);
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a)
      if (place.contains(grid, a, b)) found.push_back(grid.index(a, b));
  return found;
}

std::vector<solver::Pin> pins(const Scene& scene) {
  std::map<int, solver::Pin> merged;
  for (const PinRule& rule : scene.pins)
    for (const int i : pinned_particles(scene.sheet.grid, rule)) {
      solver::Pin& pin = merged.try_emplace(i, solver::Pin{i, {false, false, false}}).first->second;
      for (int c = 0; c < 3; ++c) {
        if (!rule.directions[c]) continue;
        pin.fixed[c] = true;
        pin.velocity[c] = rule.velocity[c];
      }
    }
  for (const int i : scene.sheet.grid.outside()) merged[i] = {i, {true, true, true}};
  std::vector<solver::Pin> all;
  for (const auto& [particle, pin] : merged) all.push_back(pin);
  return all;
}

Contacts contacts(const Scene& scene, solver::Counters& work) {
  return {scene.obstacles, scene.contact, scene.sheet.gravity.norm(), scene.sheet.grid.particles(), work};
}

solver::State start(const Scene& scene) {
  solver::State y;
  y.x = scene.sheet.grid.parameters();
  y.x.col(0) *= scene.start.stretch.weft;
  y.x.col(1) *= scene.start.stretch.warp;
  if (scene.start.pleats.count > 0) pleat(scene.start.pleats, scene.sheet.grid, y.x);
  if (scene.start.plane == Plane::vertical) y.x.col(1).swap(y.x.col(2));
  y.v = scene.start.velocity.transpose().replicate(y.x.rows(), 1);
  return y;
}

std::optional<TrimmedSurface> trimmed_surface(const Scene& scene) {
  if (scene.trim.file.empty()) return {};
  TriangleMesh pattern = read_mesh(scene.trim.file);
  for (Eigen::Vector3d& vertex : pattern.vertices) vertex *= scene.trim.scale;
  return TrimmedSurface(scene.sheet.grid, pattern);
}

Scene without_trim(Scene scene) {
  scene.trim = {};
  return scene;
}

double size(const Scene& scene) { return std::max(scene.sheet.grid.size_u, scene.sheet.grid.size_v); }

double numerical_stiffness(const Scene& scene, double h) {
  const Grid& grid = scene.sheet.grid;
  const Material& material = scene.sheet.material;
  const auto [lu, lv] = shortest_edges(grid);
  return h * h / material.density * std::max(material.tension.weft / (lu * lu), material.tension.warp / (lv * lv));
}

double stiffness_to_damping(const Scene& scene, double h) {
  const auto& [k, d] = std::tie(scene.sheet.material.tension, scene.sheet.material.damping);
  const auto ratio = [h](double modulus, double damping) {
    if (modulus == 0) return 0.0;
    return damping == 0 ? std::numeric_limits<double>::infinity() : h * modulus / damping;
  };
  return std::max(ratio(k.weft, d.weft), ratio(k.warp, d.warp));
}

}  // namespace drape::model
