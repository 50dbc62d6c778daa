#include "model/clear_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "model/garment.hpp"
#include "model/obstacles/obstacle_at_time.hpp"
#include "model/phases.hpp"
#include "model/sheet/cells.hpp"

namespace drape::model {
namespace {

using Eigen::Vector3d;

/// A part of an obstacle where it is at a time.
struct PosedPart {
  ObstacleAtTime place;
  int rule;    ///< its index among the obstacles of the scene
  bool moves;  ///< whether the obstacle does
};

std::vector<PosedPart> posed_parts(std::span<const ObstacleRule> rules, double t) {
  std::vector<PosedPart> all;
  for (const ObstacleRule& rule : rules)
    for (const Obstacle& part : parts_of(rule))
      all.push_back({ObstacleAtTime(part, t), static_cast<int>(&rule - rules.data()), moves(rule)});
  return all;
}

/// A point and the surface of a part that is nearest to it.
struct NearPoint {
  Vector3d x;
  Nearest nearest;
};

/// What of a segment is inside of a part, found along it from one end to the other.
class Piercing {
 public:
  Piercing(const ObstacleAtTime& part, double finest) : part_(part), finest_(finest) {}

  void search(const NearPoint& a, const NearPoint& b) {
    const double length = (b.x - a.x).norm();
    if (a.nearest.distance + b.nearest.distance >= length) return;
    constexpr double most_pieces = 512;  // else cloth that lies on a plane would take long where contact.distance is tiny
    resolution_ = std::max(finest_, length / most_pieces);
    pass(a.nearest);
    search(a.x, b.x, length / 2);
    pass(b.nearest);
  }

  double depth() const { return depth_; }  ///< the largest [m], 0 if all of it is outside
  bool passes() const { return passes_; }  ///< through the part, whose sides push it in directions that are nearly opposite

 private:
  /// Distances change at most as far as points move, so that what one says of its surroundings need not be searched.
  void search(const Vector3d& a, const Vector3d& b, double half) {
    const Vector3d middle = (a + b) / 2;
    const Nearest nearest = part_.nearest(middle);
    const bool is_outside = nearest.distance >= half, is_inside = nearest.distance <= -half;
    const bool searches = half > resolution_ && !is_outside && !(is_inside && nearest.distance - half >= -depth_);
    if (searches) search(a, middle, half / 2);
    pass(nearest);
    if (searches) search(middle, b, half / 2);
  }

  void pass(const Nearest& nearest) {
    if (nearest.distance >= 0) {
      entry_.reset();
      return;
    }
    depth_ = std::max(depth_, -nearest.distance);
    if (!entry_) entry_ = nearest.normal;
    constexpr double opposite = -0.5;  // 120 degrees: further than on both sides of a right-angled corner
    passes_ = passes_ || entry_->dot(nearest.normal) < opposite;
  }

  const ObstacleAtTime& part_;
  double finest_, resolution_ = 0;  ///< half the length of the pieces that are not divided [m]: the least, that of now
  std::optional<Vector3d> entry_;   ///< the normal where the segment entered, while it is inside
  double depth_ = 0;
  bool passes_ = false;
};

/// Where cloth is inside of an obstacle.
struct WrongPlace {
  double depth = 0;  ///< [m]
  bool passes = false;
  std::string whose, what;  ///< "panel 'front'", or empty; "particle [3, 4]"
  int rule = 0;
  double t = 0;  ///< [s]
};

std::string shown(const Grid& grid, int particle) { return fmt::format("[{}, {}]", particle % grid.nu, particle / grid.nu); }

/// Two particles with cloth between them.
struct ClothSegment {
  EdgeEnds ends;
  const char* name;
};

std::vector<ClothSegment> cloth_segments(const Grid& grid) {
  std::vector<ClothSegment> all;
  for (const Edge& edge : edges(grid)) all.push_back({{edge.i, edge.j}, "edge"});
  for (const Cell& cell : cells(grid)) {
    all.push_back({{cell.corner[0][0], cell.corner[1][1]}, "diagonal"});
    all.push_back({{cell.corner[1][0], cell.corner[0][1]}, "diagonal"});
  }
  return all;
}

/// The phase without seams that pull: its pins are those of the scene.
Scene with_open_seams(Scene phase) {
  if (phase.seam_state == SeamState::pulled) phase.seam_state = SeamState::open;
  return phase;
}

/// A piece of a seam that is pulled: both ends move uniformly.
struct PulledPiece {
  std::size_t seam;
  const SeamSide* side;
  EdgeEnds ends;
  Vector3d begin[2], way[2];

  Vector3d at(int end, double part) const { return begin[end] + part * way[end]; }
};

class StartSearch {
 public:
  explicit StartSearch(const Scene& scene)
      : scene_(scene),
        first_(phases(scene).front()),
        garment_(first_),
        x_(garment_.start().x),
        parts_(posed_parts(scene.obstacles, first_.begin)) {}

  WrongPlace worst() {
    search_panels();
    if (worst_.depth == 0 && first_.seam_state == SeamState::pulled) search_seams();
    return worst_;
  }

 private:
  double allowed() const { return scene_.contact.distance; }
  double resolution() const { return allowed() / 32; }

  /// How long seams are pulled [s]; the first part of the scene may end where a pin turns.
  double duration() const { return std::min(first_.seams_meet, scene_.end) - first_.begin; }

  /// `whose`, `what`: called for a place that is worse than those before.
  void note(double depth, bool passes, const PosedPart& part, double t, const auto& whose, const auto& what) {
    if ((passes || depth > allowed()) && depth > worst_.depth) worst_ = {depth, passes, whose(), what(), part.rule, t};
  }

  void search_panels() {
    std::vector<bool> held(static_cast<std::size_t>(garment_.nodes()), false);
    for (const solver::Pin& pin : garment_.pins(with_open_seams(first_), x_))
      held[static_cast<std::size_t>(pin.particle)] = pin.all();
    for (const Garment::Panel& panel : garment_.panels()) {
      const std::vector<ClothSegment> segments = cloth_segments(panel.sheet.grid);
      for (const PosedPart& part : parts_) search_panel(panel, segments, part, held);
    }
  }

  void search_panel(const Garment::Panel& panel, const std::vector<ClothSegment>& segments, const PosedPart& part,
                    const std::vector<bool>& held) {
    const Grid& grid = panel.sheet.grid;
    const auto whose = [&] { return panel.name.empty() ? std::string() : fmt::format("panel '{}'", panel.name); };
    const auto is_held = [&](int i) { return held[static_cast<std::size_t>(panel.node(i))]; };
    std::vector<NearPoint> points;
    for (int i = 0; i < grid.particles(); ++i) {
      const Vector3d x = x_.row(panel.node(i));
      points.push_back({x, part.place.nearest(x)});
      if (!is_held(i))
        note(-points.back().nearest.distance, false, part, first_.begin, whose, [&] { return "particle " + shown(grid, i); });
    }
    for (const ClothSegment& segment : segments) {
      const int i = segment.ends.begin, j = segment.ends.end;
      if (is_held(i) || is_held(j)) continue;
      Piercing piercing(part.place, resolution());
      piercing.search(points[static_cast<std::size_t>(i)], points[static_cast<std::size_t>(j)]);
      note(piercing.depth(), piercing.passes(), part, first_.begin, whose,
           [&] { return fmt::format("the {} from {} to {}", segment.name, shown(grid, i), shown(grid, j)); });
    }
  }

  std::vector<PulledPiece> pulled_pieces() const {
    std::map<int, Vector3d> velocities;
    for (const solver::Pin& pin : garment_.pins(first_, x_)) velocities[pin.particle] = pin.velocity;
    std::vector<PulledPiece> all;
    for (std::size_t k = 0; k < scene_.seams.size(); ++k)
      for (const SeamSide* side : {&scene_.seams[k].one, &scene_.seams[k].other}) {
        const Garment::Panel& panel = garment_.panel(side->panel);
        const std::vector<int> particles = sewn_particles(panel.sheet.grid, *side);
        for (std::size_t p = 1; p < particles.size(); ++p) {
          PulledPiece& piece = all.emplace_back(PulledPiece{k, side, {particles[p - 1], particles[p]}, {}, {}});
          for (const int end : {0, 1}) {
            const int node = panel.node(particles[p - 1 + static_cast<std::size_t>(end)]);
            piece.begin[end] = x_.row(node);
            const auto velocity = velocities.find(node);  // the tip of a dart has none
            piece.way[end].setZero();
            if (velocity != velocities.end()) piece.way[end] = duration() * velocity->second;
          }
        }
      }
    return all;
  }

  void search_seams() {
    const std::vector<PulledPiece> pieces = pulled_pieces();
    double longest = 0;
    for (const PulledPiece& piece : pieces) longest = std::max({longest, piece.way[0].norm(), piece.way[1].norm()});
    constexpr double fewest = 16, most = 1000;
    const int times = static_cast<int>(std::clamp(std::ceil(longest / (allowed() / 2)), fewest, most));
    for (PosedPart& part : parts_) {
      const std::vector<PulledPiece> near = within_reach(pieces, part);
      for (int k = 1; k <= times && !near.empty(); ++k) {
        const double passed = static_cast<double>(k) / times, t = first_.begin + passed * duration();
        part.place.set_time(t);
        for (const PulledPiece& piece : near) search_piece(piece, part, passed, t);
      }
    }
  }

  /// The pieces that may touch a part on their way: all, if it moves.
  static std::vector<PulledPiece> within_reach(const std::vector<PulledPiece>& pieces, const PosedPart& part) {
    if (part.moves) return pieces;
    std::vector<PulledPiece> all;
    for (const PulledPiece& piece : pieces) {
      const Vector3d middle = (piece.at(0, 0.5) + piece.at(1, 0.5)) / 2;
      double radius = 0;
      for (const int end : {0, 1})
        for (const double passed : {0.0, 1.0}) radius = std::max(radius, (piece.at(end, passed) - middle).norm());
      if (part.place.nearest(middle).distance < radius) all.push_back(piece);
    }
    return all;
  }

  void search_piece(const PulledPiece& piece, const PosedPart& part, double passed, double t) {
    const auto whose = [&] { return fmt::format("seams[{}]", piece.seam); };
    const Grid& grid = garment_.panel(piece.side->panel).sheet.grid;
    const auto end = [&](int k) {
      const Vector3d x = piece.at(k, passed);
      return NearPoint{x, part.place.nearest(x)};
    };
    const NearPoint a = end(0), b = end(1);
    const std::string_view of_side = panel_side_names[static_cast<std::size_t>(piece.side->side)];
    const auto particle = [&](int i) {
      return [&, i] { return fmt::format("particle {} on {} {}", shown(grid, i), piece.side->panel, of_side); };
    };
    note(-a.nearest.distance, false, part, t, whose, particle(piece.ends.begin));
    note(-b.nearest.distance, false, part, t, whose, particle(piece.ends.end));
    Piercing piercing(part.place, resolution());
    piercing.search(a, b);
    note(piercing.depth(), piercing.passes(), part, t, whose, [&] {
      return fmt::format("the edge from {} to {} on {} {}", shown(grid, piece.ends.begin), shown(grid, piece.ends.end),
                         piece.side->panel, of_side);
    });
  }

  const Scene& scene_;
  const Scene first_;  ///< phase
  const Garment garment_;
  const Vectors x_;  ///< of nodes, at the start
  std::vector<PosedPart> parts_;
  WrongPlace worst_;
};

}  // namespace

void require_clear_start(const Scene& scene) {
  if (scene.obstacles.empty()) return;
  const WrongPlace worst = StartSearch(scene).worst();
  if (worst.depth == 0) return;
  const std::string whose = worst.whose.empty() ? "" : worst.whose + ": ";
  const std::string obstacle =
      fmt::format("obstacles[{}] ({})", worst.rule, scene.obstacles[static_cast<std::size_t>(worst.rule)].kind->name);
  const std::string verb = worst.whose.starts_with("seams") ? "be pulled" : "begin";
  throw std::invalid_argument(
      worst.passes
          ? fmt::format("{}expected {} not to pass through {}, {:.3g} m deep at t = {:.4g} s", whose, worst.what, obstacle,
                        worst.depth, worst.t)
          : fmt::format("{}expected {} to {} at most contact.distance = {:g} m inside {}, not {:.3g} m at t = {:.4g} s", whose,
                        worst.what, verb, scene.contact.distance, obstacle, worst.depth, worst.t));
}

}  // namespace drape::model
