#include "model/scene.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <tuple>

#include "model/garment.hpp"
#include "model/obstacles/mesh_file.hpp"
#include "model/outline_mesh.hpp"
#include "model/sheet/edges.hpp"
#include "solver/base/registry.hpp"

namespace drape::model {
namespace {

using Place = bool (*)(const Grid& grid, int a, int b);

struct NamedPlace {
  std::string_view name;
  Place contains;
};

constexpr auto on_left = [](const Grid&, int a, int) { return a == 0; };
constexpr auto on_right = [](const Grid& grid, int a, int) { return a == grid.nu - 1; };
constexpr auto on_lower = [](const Grid&, int, int b) { return b == 0; };
constexpr auto on_upper = [](const Grid& grid, int, int b) { return b == grid.nv - 1; };
constexpr auto on_a_side = [](const Grid& grid, int a, int b) { return on_left(grid, a, b) || on_right(grid, a, b); };
constexpr auto on_an_end = [](const Grid& grid, int a, int b) { return on_lower(grid, a, b) || on_upper(grid, a, b); };

constexpr NamedPlace places[] = {
    {"left edge", on_left},
    {"right edge", on_right},
    {"lower edge", on_lower},
    {"upper edge", on_upper},
    {"border", [](const Grid& g, int a, int b) { return on_a_side(g, a, b) || on_an_end(g, a, b); }},
    {"corners", [](const Grid& g, int a, int b) { return on_a_side(g, a, b) && on_an_end(g, a, b); }},
    {"upper corners", [](const Grid& g, int a, int b) { return on_a_side(g, a, b) && on_upper(g, a, b); }},
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

/// Lengths of the half of an ellipse of half width 1 from −x on, by equidistant angles.
std::vector<double> lengths_of_half_ellipse(double depth) {
  constexpr int chords = 4096;
  std::vector<double> passed{0};
  Eigen::Vector2d last(-1, 0);
  for (int k = 1; k <= chords; ++k) {
    const double angle = std::numbers::pi * k / chords;
    const Eigen::Vector2d point(-std::cos(angle), -depth * std::sin(angle));
    passed.push_back(passed.back() + (point - last).norm());
    last = point;
  }
  return passed;
}

/// Lays every line along u on the half of an ellipse around the z axis at its mean height.
void wrap(double depth, const Grid& grid, solver::Vectors& x) {
  const std::vector<double> passed = lengths_of_half_ellipse(depth);
  for (int b = 0; b < grid.nv; ++b) {
    std::vector<double> along{0};
    double height = x(grid.index(0, b), 2);
    for (int a = 1; a < grid.nu; ++a) {
      along.push_back(along.back() + (x.row(grid.index(a, b)) - x.row(grid.index(a - 1, b))).norm());
      height += x(grid.index(a, b), 2);
    }
    const double half_width = along.back() / passed.back();
    for (int a = 0; a < grid.nu; ++a) {
      const double wanted = along[static_cast<std::size_t>(a)] / half_width;
      const auto next = std::clamp(std::ranges::upper_bound(passed, wanted), passed.begin() + 1, passed.end() - 1);
      const double part = (wanted - *(next - 1)) / (*next - *(next - 1));
      const double angle =
          std::numbers::pi * (static_cast<double>(next - 1 - passed.begin()) + part) / static_cast<double>(passed.size() - 1);
      x.row(grid.index(a, b)) << -half_width * std::cos(angle), -depth * half_width * std::sin(angle), height / grid.nu;
    }
  }
}

/// Turns about the origin, then moves.
void move(const Start& start, solver::Vectors& x) {
  if (const double degrees = start.rotation.norm(); degrees > 0)
    x *= Eigen::AngleAxisd(degrees * std::numbers::pi / 180, start.rotation / degrees).toRotationMatrix().transpose();
  if (!start.position.isZero(0)) x.rowwise() += start.position.transpose();
}

TrimmedSurface surface_of(const Grid& grid, const Trim& trim) {
  if (trim.outline && !trim.file.empty()) throw std::invalid_argument("expected a file or an outline, not both");
  constexpr double beyond_corners = 2;  // of pieces between particles: lines of the grid cut them off
  if (trim.outline) return TrimmedSurface(grid, outline_mesh(grid), beyond_corners);
  TriangleMesh pattern = read_mesh(trim.file);
  for (Eigen::Vector3d& vertex : pattern.vertices) vertex *= trim.scale;
  return TrimmedSurface(grid, pattern);
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

const Grid& pinned_grid(const Scene& scene, const PinRule& rule) {
  return scene.panels.empty() ? scene.sheet.grid : find_panel(scene, rule.panel).grid;
}

std::vector<solver::Pin> pins(const Scene& scene) {
  const Garment garment(scene);
  return garment.pins(scene, garment.start().x);
}

Contacts contacts(const Scene& scene, solver::Counters& work) {
  return {scene.obstacles, scene.contact, scene.sheet.gravity, Garment(scene).nodes(), work};
}

solver::State start_of(const Grid& grid, const Start& start) {
  solver::State y;
  y.x = grid.parameters();
  y.x.col(0) *= start.stretch.weft;
  y.x.col(1) *= start.stretch.warp;
  if (start.pleats.count > 0) pleat(start.pleats, grid, y.x);
  if (start.plane == Plane::vertical) y.x.col(1).swap(y.x.col(2));
  if (start.wrap > 0) wrap(start.wrap, grid, y.x);
  move(start, y.x);
  y.v = start.velocity.transpose().replicate(y.x.rows(), 1);
  return y;
}

solver::State start(const Scene& scene) { return Garment(scene).start(); }

std::optional<TrimmedSurface> trimmed_surface(const Scene& scene) {
  if (scene.panels.empty()) {
    if (!scene.trim.given()) return {};
    return surface_of(scene.sheet.grid, scene.trim);
  }
  if (std::ranges::none_of(scene.panels, [](const PanelRule& panel) { return panel.trim.given(); })) return {};
  TrimmedSurface all;
  int first = 0;
  for (const PanelRule& panel : scene.panels) {
    try {
      all.add(panel.trim.given() ? surface_of(panel.grid, panel.trim) : TrimmedSurface(panel.grid), first);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("panel '{}': {}", panel.name, error.what()));
    }
    first += panel.grid.particles();
  }
  return all;
}

Scene without_trim(Scene scene) {
  scene.trim = {};
  for (PanelRule& panel : scene.panels) panel.trim = {};
  return scene;
}

bool has_contacts(const Scene& scene) { return !scene.obstacles.empty() || scene.contact.thickness > 0; }

double size(const Scene& scene) {
  double longest = 0;
  const Garment garment(scene);
  for (const Garment::Panel& panel : garment.panels())
    longest = std::max({longest, panel.sheet.grid.size_u, panel.sheet.grid.size_v});
  return longest;
}

double numerical_stiffness(const Scene& scene, double h) {
  double largest = 0;
  const Garment garment(scene);
  for (const Garment::Panel& panel : garment.panels()) {
    const Material& material = panel.sheet.material;
    const auto [lu, lv] = shortest_edges(panel.sheet.grid);
    const double stiffness = std::max(material.tension.weft / (lu * lu), material.tension.warp / (lv * lv));
    largest = std::max(largest, h * h / material.density * stiffness);
  }
  return largest;
}

double stiffness_to_damping(const Scene& scene, double h) {
  const auto ratio = [h](double modulus, double damping) {
    if (modulus == 0) return 0.0;
    return damping == 0 ? std::numeric_limits<double>::infinity() : h * modulus / damping;
  };
  double largest = 0;
  const Garment garment(scene);
  for (const Garment::Panel& panel : garment.panels()) {
    const auto& [k, d] = std::tie(panel.sheet.material.tension, panel.sheet.material.damping);
    largest = std::max({largest, ratio(k.weft, d.weft), ratio(k.warp, d.warp)});
  }
  return largest;
}

}  // namespace drape::model
