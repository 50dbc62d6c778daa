#include "model/garment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "model/sheet/cells.hpp"
#include "solver/base/disjoint_sets.hpp"
#include "solver/base/registry.hpp"

namespace drape::model {
namespace {

std::string shown(const SeamSide& side) {
  return fmt::format("{} {}", side.panel, panel_side_names[static_cast<std::size_t>(side.side)]);
}

template <class Panel>
const Panel& named(const std::vector<Panel>& panels, const std::string& name) {
  const auto found = std::ranges::find(panels, name, &Panel::name);
  if (found != panels.end()) return *found;
  std::vector<std::string_view> names;
  for (const Panel& panel : panels) names.push_back(panel.name);
  throw std::invalid_argument(base::unknown_name("panel", name, names));
}

Eigen::VectorXd masses_of(const Sheet& sheet) {
  const Eigen::VectorXd areas = sheet.grid.cell_areas();
  const double mean = areas.sum() / static_cast<double>((areas.array() > 0).count());
  return sheet.material.density * (areas.array() > 0).select(areas, mean);
}

void require_cloth(const Grid& grid, const std::vector<int>& particles, const SeamSide& side) {
  const std::vector<int> outside = grid.outside();  // in order
  if (std::ranges::any_of(particles, [&](int i) { return std::ranges::binary_search(outside, i); }))
    throw std::invalid_argument(fmt::format("expected cloth on all of {}, a cut leaves a part of it outside", shown(side)));
}

/// Adds a value of each particle of a panel to that of its node.
void add(const Garment::Panel& panel, const Eigen::VectorXd& own, Eigen::VectorXd& all) {
  for (int i = 0; i < own.size(); ++i) all[panel.node(i)] += own[i];
}

}  // namespace

const Vectors& Garment::Panel::seen(const Vectors& all, Vectors& own) const {
  if (nodes.empty()) return all;
  own.resize(std::ssize(nodes), 3);
  for (int i = 0; i < std::ssize(nodes); ++i) own.row(i) = all.row(node(i));
  return own;
}

void Garment::Panel::add(const Vectors& own, Vectors& all) const {
  for (int i = 0; i < own.rows(); ++i) all.row(node(i)) += own.row(i);
}

Garment::Garment(const Scene& scene) {
  const auto add = [&](const std::string& name, const Sheet& sheet, const Start& start) {
    panels_.push_back({name, sheet, start, particles_, {}});
    particles_ += sheet.grid.particles();
  };
  if (scene.panels.empty()) add("", scene.sheet, scene.start);
  for (const PanelRule& rule : scene.panels) {
    Sheet sheet = scene.sheet;
    sheet.grid = rule.grid;
    sheet.material = rule.material;
    add(rule.name, sheet, rule.start);
  }
  nodes_ = particles_;
  const bool is_sewn = scene.seam_state == SeamState::sewn;
  if (panels_.size() > 1 || !scene.seams.empty()) sew(is_sewn ? std::span(scene.seams) : std::span<const SeamRule>());
  if (scene.seam_state == SeamState::pulled) {
    Scene closed = scene;
    closed.seam_state = SeamState::sewn;
    const Garment sewn(closed);
    sewn_.resize(static_cast<std::size_t>(nodes_));
    for (std::size_t k = 0; k < panels_.size(); ++k)
      for (int i = 0; i < panels_[k].sheet.grid.particles(); ++i)
        sewn_[static_cast<std::size_t>(panels_[k].node(i))] = sewn.panels_[k].node(i);
  }
  if (scene.rest == RestShape::start) {
    const Vectors x = start().x;
    for (Panel& panel : panels_) {
      Vectors own;
      panel.sheet.rest = panel.seen(x, own);
    }
  }
}

const Garment::Panel& Garment::panel(const std::string& name) const { return named<Panel>(panels_, name); }

std::vector<std::pair<int, int>> Garment::pairs(const SeamRule& seam) const {
  const Panel &one = panel(seam.one.panel), &other = panel(seam.other.panel);
  const std::vector<int> first = sewn_particles(one.sheet.grid, seam.one);
  const std::vector<int> second = sewn_particles(other.sheet.grid, seam.other);
  if (first.size() != second.size())
    throw std::invalid_argument(fmt::format("expected as many particles on {} as on {}, not {} and {}", shown(seam.one),
                                            shown(seam.other), first.size(), second.size()));
  const double l = sewn_length(one.sheet.grid, seam.one), m = sewn_length(other.sheet.grid, seam.other);
  if (std::max(l, m) > (1 + seam.ease) * std::min(l, m))
    throw std::invalid_argument(
        fmt::format("expected lengths that differ by {:g} % at most (ease = {:g}), {} has {:.4g} m and {} {:.4g} m",
                    100 * seam.ease, seam.ease, shown(seam.one), l, shown(seam.other), m));
  require_cloth(one.sheet.grid, first, seam.one);
  require_cloth(other.sheet.grid, second, seam.other);
  std::vector<std::pair<int, int>> all;
  for (std::size_t k = 0; k < first.size(); ++k) all.emplace_back(one.first + first[k], other.first + second[k]);
  return all;
}

void Garment::sew(std::span<const SeamRule> seams) {
  base::DisjointSets joined(particles_);  // whose particles are one node
  for (std::size_t k = 0; k < seams.size(); ++k) try {
      for (const auto& [i, j] : pairs(seams[k])) joined.join(i, j);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("seams[{}]: {}", k, error.what()));
    }
  std::vector<int> node(static_cast<std::size_t>(particles_), -1);
  nodes_ = 0;
  for (Panel& panel : panels_)
    for (int i = 0; i < panel.sheet.grid.particles(); ++i) {
      int& of_root = node[static_cast<std::size_t>(joined.root(panel.first + i))];
      if (of_root < 0) of_root = nodes_++;
      panel.nodes.push_back(of_root);
    }
  for (const Panel& panel : panels_)
    for (const Edge& edge : edges(panel.sheet.grid))
      if (panel.node(edge.i) == panel.node(edge.j))
        throw std::invalid_argument(
            fmt::format("seams: expected to join no neighbours, {} and {} of {} would be one", edge.i, edge.j, panel.name));
}

Eigen::VectorXd Garment::masses() const {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(nodes_);
  for (const Panel& panel : panels_) model::add(panel, masses_of(panel.sheet), all);
  return all;
}

Eigen::VectorXd Garment::cloth_masses() const {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(nodes_);
  for (const Panel& panel : panels_) model::add(panel, panel.sheet.material.density * panel.sheet.grid.cell_areas(), all);
  return all;
}

Eigen::VectorXd Garment::areas() const {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(nodes_);
  for (const Panel& panel : panels_) model::add(panel, panel.sheet.grid.cell_areas(), all);
  return all;
}

solver::State Garment::start() const {
  if (is_one_sheet()) return start_of(panels_.front().sheet.grid, panels_.front().start);
  solver::State all{Vectors(particles_, 3), Vectors(particles_, 3)};
  for (const Panel& panel : panels_) {
    const solver::State own = start_of(panel.sheet.grid, panel.start);
    all.x.middleRows(panel.first, own.x.rows()) = own.x;
    all.v.middleRows(panel.first, own.v.rows()) = own.v;
  }
  return gathered(all);
}

solver::State Garment::gathered(const solver::State& of_particles) const {
  if (is_one_sheet()) return of_particles;
  solver::State y{Vectors::Zero(nodes_, 3), Vectors::Zero(nodes_, 3)};
  for (const Panel& panel : panels_) {
    const Eigen::VectorXd mass = masses_of(panel.sheet);
    panel.add(mass.asDiagonal() * of_particles.x.middleRows(panel.first, mass.size()), y.x);
    panel.add(mass.asDiagonal() * of_particles.v.middleRows(panel.first, mass.size()), y.v);
  }
  const Eigen::VectorXd inverse = masses().cwiseInverse();
  y.x = inverse.asDiagonal() * y.x;
  y.v = inverse.asDiagonal() * y.v;
  return y;
}

namespace {

/// The directions in which the rules of a node prescribe its velocity, orthonormal, and the velocities along them [m/s].
class HeldDirections {
 public:
  /// Holds the direction d as well, unless the others hold it already.
  void hold(const Eigen::Vector3d& d, double velocity) {
    constexpr double parallel = 1e-6;
    const Eigen::Vector3d rest = d - pin_.held * d;
    const double length = rest.norm();
    if (length <= parallel) return;
    const Eigen::Vector3d n = rest / length;
    pin_.velocity += (velocity - pin_.velocity.dot(d)) / length * n;
    pin_.held += n * n.transpose();
    if (++count_ == 3) pin_.held.setIdentity();  // not only to round-off
  }

  solver::Pin pin(int node) const { return {node, pin_.held, pin_.velocity}; }

 private:
  solver::Pin pin_{0, Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero()};
  int count_ = 0;
};

void hold(const PinRule& rule, HeldDirections& node) {
  if (rule.oblique()) {
    const Eigen::Vector3d d = rule.direction.stableNormalized();
    return node.hold(d, rule.velocity.dot(d));
  }
  for (int c = 0; c < 3; ++c)
    if (rule.directions[c]) node.hold(Eigen::Vector3d::Unit(c), rule.velocity[c]);
}

}  // namespace

std::vector<solver::Pin> Garment::pins(const Scene& phase, const Vectors& x) const {
  std::map<int, HeldDirections> held;
  for (auto rule = phase.pins.rbegin(); rule != phase.pins.rend(); ++rule) {  // what holds first wins
    const Panel& of = panel(rule->panel);
    for (const int particle : pinned_particles(of.sheet.grid, *rule)) hold(*rule, held[of.node(particle)]);
  }
  std::map<int, solver::Pin> merged;
  for (const auto& [node, directions] : held) merged[node] = directions.pin(node);
  if (phase.seam_state == SeamState::pulled)
    for (const auto& [node, velocity] : pulled(phase, x)) merged[node] = {.particle = node, .velocity = velocity};
  for (const int i : outside()) merged[i] = {.particle = i};
  std::vector<solver::Pin> all;
  for (const auto& [particle, pin] : merged) all.push_back(pin);
  return all;
}

std::map<int, Eigen::Vector3d> Garment::pulled(const Scene& phase, const Vectors& x) const {
  std::map<int, std::vector<int>> meeting;
  for (int node = 0; node < nodes_; ++node) meeting[sewn_[static_cast<std::size_t>(node)]].push_back(node);
  std::map<int, Eigen::Vector3d> velocities;
  for (const auto& [sewn, nodes] : meeting) {
    if (nodes.size() < 2) continue;
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    for (const int node : nodes) place += x.row(node).transpose() / static_cast<double>(nodes.size());
    for (const int node : nodes) velocities[node] = (place - x.row(node).transpose()) / (phase.seams_meet - phase.begin);
  }
  return velocities;
}

std::vector<int> Garment::outside() const {
  std::vector<int> all;
  for (const Panel& panel : panels_)
    for (const int i : panel.sheet.grid.outside()) all.push_back(panel.node(i));
  return all;
}

Vectors Garment::spread(const Vectors& nodes) const {
  if (is_one_sheet()) return nodes;
  Vectors all(particles_, 3);
  for (const Panel& panel : panels_)
    for (int i = 0; i < std::ssize(panel.nodes); ++i) all.row(panel.first + i) = nodes.row(panel.node(i));
  return all;
}

std::vector<int> Garment::spread(const std::vector<int>& nodes) const {
  if (is_one_sheet()) return nodes;
  std::vector<int> all;
  for (const Panel& panel : panels_)
    for (const int node : panel.nodes) all.push_back(nodes[static_cast<std::size_t>(node)]);
  return all;
}

Polygons garment_polygons(const Garment& garment, const Vectors& x) {
  Polygons all;
  for (Eigen::Index i = 0; i < x.rows(); ++i) all.vertices.emplace_back(x.row(i));
  for (const Garment::Panel& panel : garment.panels()) {
    Vectors own;
    for (std::vector<int> face : sheet_polygons(panel.sheet.grid, panel.seen(x, own)).faces) {
      for (int& corner : face) corner = panel.node(corner);
      all.faces.push_back(std::move(face));
    }
  }
  return all;
}

int nodes(const Scene& scene) { return Garment(scene).nodes(); }

const PanelRule& find_panel(const Scene& scene, const std::string& name) { return named<PanelRule>(scene.panels, name); }

std::vector<int> sewn_particles(const Grid& grid, const SeamSide& side) {
  const bool along_u = side.side == PanelSide::lower || side.side == PanelSide::upper;
  const int count = along_u ? grid.nu : grid.nv;
  const int first = side.ends.empty() ? 0 : side.ends.front(), last = side.ends.empty() ? count - 1 : side.ends.back();
  if (std::max(first, last) >= count || first == last)
    throw std::invalid_argument(
        fmt::format("expected ends below {}, the particles on {}, not {} and {}", count, shown(side), first, last));
  std::vector<int> all;
  for (int k = first;; k += first < last ? 1 : -1) {
    switch (side.side) {
      case PanelSide::lower: all.push_back(grid.index(k, 0)); break;
      case PanelSide::upper: all.push_back(grid.index(k, grid.nv - 1)); break;
      case PanelSide::left: all.push_back(grid.index(0, k)); break;
      case PanelSide::right: all.push_back(grid.index(grid.nu - 1, k)); break;
    }
    if (k == last) return all;
  }
}

double sewn_length(const Grid& grid, const SeamSide& side) {
  const Vectors pattern = grid.parameters();
  const std::vector<int> particles = sewn_particles(grid, side);
  double sum = 0;
  for (std::size_t k = 1; k < particles.size(); ++k) sum += (pattern.row(particles[k]) - pattern.row(particles[k - 1])).norm();
  return sum;
}

}  // namespace drape::model
