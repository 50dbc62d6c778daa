#include "bench/runs/trajectory_observer.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "bench/runs/contact_observer.hpp"
#include "model/sheet/edges.hpp"
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

/// Of all nodes.
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

std::vector<double> frame_times(double every, double end) {
  std::vector<double> times;
  const double last = end / every * (1 + 1e-9);  // round-off, not intention
  for (int k = 1; k <= last; ++k) times.push_back(k * every);
  return times;
}

void TrajectoryObserver::begin(const model::Scene& scene, const model::Cloth& cloth, const solver::State&) {
  scene_ = &scene;
  cloth_ = &cloth;
  start_ = reference::prescribed_start(cloth.ode, cloth.start);
  times_ = frame_times(every_, scene.end);
  output_.emplace(times_, 0, start_);
}

void TrajectoryObserver::finish() {
  const model::Garment& garment = *cloth_->garment;
  const std::vector<model::Edge> edges = edges_of(garment);
  results::TrajectoryRecord& record = record_.emplace(results::TrajectoryRecord{
      .nu = garment.particles(), .nv = 1, .panels = {}, .times = {0}, .states = {}, .stretch = {}, .constraint = {}});
  for (const model::Garment::Panel& panel : garment.panels())
    record.panels.push_back({panel.sheet.grid.nu, panel.sheet.grid.nv});
  if (record.panels.size() == 1) {
    record.nu = record.panels[0][0], record.nv = record.panels[0][1];
    record.panels.clear();
  }
  record.times.insert(record.times.end(), times_.begin(), times_.begin() + std::ssize(output_->states));
  std::vector<solver::State> states{start_};
  states.insert(states.end(), output_->states.begin(), output_->states.end());
  for (std::size_t k = 0; k < record.times.size(); ++k) {
    record.constraint.push_back(garment.spread(constraints(*scene_, *cloth_, record.times[k], states[k].x)));
    record.states.push_back({garment.spread(states[k].x), garment.spread(states[k].v), states[k].z});
    record.stretch.push_back(mean_strain(edges, record.states[k].x));
  }
}

}  // namespace drape::bench
