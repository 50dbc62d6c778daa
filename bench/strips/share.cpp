#include "bench/strips/share.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "model/phases.hpp"

namespace drape::bench::strips {
namespace {

/// A force that lines farther than the next one take part in, or that remembers; empty if there is none. What forces there are
/// depends on the spacing and not on the number of particles.
std::string farther_force(model::Sheet sheet) {
  constexpr int few = 3;
  model::Grid& grid = sheet.grid;
  const double u = grid.spacing_u(), v = grid.spacing_v();
  grid.nu = grid.nv = few;
  grid.size_u = u * (few - 1);
  grid.size_v = v * (few - 1);
  for (const model::TermKind& kind : model::term_kinds_of(sheet)) {
    const std::optional<model::Term> term = model::make_term(kind, sheet);
    if (term && (term->force || term->springs || term->memory)) return std::string(kind.name);
  }
  return "";
}

std::string reason_against(const model::Scene& scene) {
  const model::Grid& grid = scene.sheet.grid;
  if (!scene.panels.empty()) return "it has panels";
  if (!grid.uniform() || grid.nu < 2 || grid.nv < 2) return "its grid is not uniform";
  if (model::has_contacts(scene)) return "it has obstacles or contact";
  if (model::phases(scene).size() > 1) return "it has phases or paths of pins";
  if (scene.start.wrap > 0) return "it is wrapped";
  if (const std::string force = farther_force(scene.sheet); !force.empty()) return "it has the force " + force;
  return "";
}

/// Where the first line of a strip begins, relative to that of the sheet [m].
Eigen::Vector3d offset(const model::Scene& whole, const Share& share) {
  const model::Start& start = whole.start;
  const double along = share.copied_first() * whole.sheet.grid.spacing_v() * start.stretch.warp;
  const Eigen::Vector3d flat = along * Eigen::Vector3d::Unit(start.plane == model::Plane::vertical ? 2 : 1);
  const double degrees = start.rotation.norm();
  if (degrees == 0) return flat;
  return Eigen::AngleAxisd(degrees * std::numbers::pi / 180, start.rotation / degrees) * flat;
}

}  // namespace

std::vector<Share> shares(int lines, int processes, const std::vector<int>& wanted) {
  if (processes > lines)
    throw std::invalid_argument(fmt::format("expected at most {0} processes for {0} lines, not {1}", lines, processes));
  std::vector<int> heights = wanted;
  if (heights.empty())
    for (int k = 0; k < processes; ++k) heights.push_back((k + 1) * lines / processes - k * lines / processes);
  if (std::ssize(heights) != processes || std::ranges::min(heights) < 1 ||
      std::accumulate(heights.begin(), heights.end(), 0) != lines)
    throw std::invalid_argument(
        fmt::format("lines: expected {} positive numbers, one for each process, with the sum {}", processes, lines));
  std::vector<Share> all;
  for (int first = 0; const int height : heights) {
    all.push_back({first, height, first > 0, first + height < lines});
    first += height;
  }
  return all;
}

model::Scene strip_of(const model::Scene& whole, const Share& share) {
  if (const std::string reason = reason_against(whole); !reason.empty())
    throw std::invalid_argument(fmt::format(
        "{}: expected one uniform sheet with forces between neighbours and weight only, but {}", whole.name, reason));
  model::Scene strip = whole;
  model::Grid& grid = strip.sheet.grid;
  grid.nv = share.copied_lines();
  grid.size_v = whole.sheet.grid.spacing_v() * (grid.nv - 1);
  strip.start.position += offset(whole, share);
  strip.pins.clear();
  for (const model::PinRule& rule : whole.pins) {
    model::PinRule own = rule;
    own.where.clear();
    own.circle.setZero();
    own.particles.clear();
    for (const int particle : model::pinned_particles(whole.sheet.grid, rule)) {
      const int line = particle / grid.nu - share.copied_first();
      if (line >= 0 && line < grid.nv) own.particles.emplace_back(particle % grid.nu, line);
    }
    if (!own.particles.empty()) strip.pins.push_back(std::move(own));
  }
  return strip;
}

Eigen::VectorXd strip_masses(const model::Scene& whole, const Share& share, Eigen::VectorXd masses) {
  model::Grid strip = whole.sheet.grid;
  strip.nv = share.copied_lines();
  strip.size_v = whole.sheet.grid.spacing_v() * (strip.nv - 1);
  for (const int line : {0, strip.nv - 1})
    masses.segment(strip.index(0, line), strip.nu) *=
        whole.sheet.grid.cell_width_v(share.copied_first() + line) / strip.cell_width_v(line);
  return masses;
}

}  // namespace drape::bench::strips
