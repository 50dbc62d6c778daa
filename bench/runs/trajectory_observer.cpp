#include "bench/runs/trajectory_observer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "bench/runs/contact_observer.hpp"
#include "reference/sundials/coordinates.hpp"

namespace drape::bench {
namespace {

/// All edges, by particles of the garment.
std::vector<model::Edge> edges_of(const model::Garment& garment) {
  std::vector<model::Edge> all;
  for (const model::Garment::Panel& panel : garment.panels())
    for (model::Edge edge : model::edges(panel.sheet.grid)) {
      edge.i += panel.first, edge.j += panel.first;
      all.push_back(edge);
    }
  return all;
}

/// The mean strain of the edges that meet in each particle; 0 if none do.
Eigen::VectorXd mean_strain(const std::vector<model::Edge>& edges, const solver::Vectors& x) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(x.rows()), count = sum;
  for (const model::Edge& edge : edges) {
    const double strain = (x.row(edge.i) - x.row(edge.j)).norm() / edge.length - 1;
    for (const int end : {edge.i, edge.j}) sum[end] += strain, count[end] += 1;
  }
  return sum.cwiseQuotient(count.cwiseMax(1));
}

/// What constrains each node.
std::vector<int> constraints(const model::Scene& scene, const model::Cloth& cloth, double t, const solver::Vectors& x) {
  std::vector<int> kinds(static_cast<std::size_t>(cloth.ode.particles()), int(results::Constraint::free));
  const std::vector<bool> touching = in_contact(scene, cloth, t, x);
  for (std::size_t i = 0; i < touching.size(); ++i)
    if (touching[i]) kinds[i] = int(results::Constraint::in_contact);
  for (const solver::Pin& pin : cloth.ode.pins)
    kinds[static_cast<std::size_t>(pin.particle)] = int(results::Constraint::pinned);
  for (const int i : cloth.garment->outside()) kinds[static_cast<std::size_t>(i)] = int(results::Constraint::no_cloth);
  return kinds;
}

}  // namespace

void check_frames(const char* option, double every, double end) {
  constexpr double most = 1e5;
  if (!(end / every <= most))
    throw std::invalid_argument(
        fmt::format("{}: expected at most {:g} frames to t = {:g} s, so every {:g} s at least, not {:g}", option, most, end,
                    end / most, every));
}

std::vector<double> frame_times(double every, double begin, double end) {
  constexpr double round_off = 1e-9;  // not intention
  std::vector<double> times;
  for (double k = std::floor(begin / every * (1 + round_off)) + 1; k <= end / every * (1 + round_off); ++k)
    times.push_back(k * every);
  return times;
}

void TrajectoryObserver::begin(const model::Scene& scene, const model::Cloth& cloth, const solver::State&) {
  keep_phase();
  const solver::State start = reference::prescribed_start(cloth.ode, cloth.start);
  scene_ = &scene;
  cloth_ = &cloth;
  edges_ = edges_of(*cloth.garment);
  times_ = frame_times(every_, cloth.begin, scene.end);
  output_.emplace(times_, cloth.begin, start);
  if (record_) return;
  record_.emplace();
  keep(0, start);
}

void TrajectoryObserver::finish() {
  keep_phase();
  output_.reset();
}

void TrajectoryObserver::keep_phase() {
  if (!output_) return;
  for (std::size_t k = 0; k < output_->states.size(); ++k) keep(times_[k], output_->states[k]);
}

void TrajectoryObserver::keep(double t, const solver::State& y) {
  const model::Garment& garment = *cloth_->garment;
  results::TrajectoryRecord& record = *record_;
  record.nu = garment.particles(), record.nv = 1;
  record.panels.clear();
  for (const model::Garment::Panel& panel : garment.panels())
    record.panels.push_back({panel.sheet.grid.nu, panel.sheet.grid.nv});
  if (record.panels.size() == 1) {
    record.nu = record.panels[0][0], record.nv = record.panels[0][1];
    record.panels.clear();
  }
  record.times.push_back(t);
  record.states.push_back({garment.spread(y.x), garment.spread(y.v), y.z});
  record.stretch.push_back(mean_strain(edges_, record.states.back().x));
  record.constraint.push_back(garment.spread(constraints(*scene_, *cloth_, t, y.x)));
}

}  // namespace drape::bench
