#include "reference/plausible.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "reference/reference_file.hpp"
#include "reference/stepped.hpp"
#include "reference/sundials/coordinates.hpp"
#include "solver/integrator.hpp"

namespace drape::reference {
namespace {

using solver::SplitOde;
using solver::State;

constexpr double tolerance = 1e-4;  ///< of the loose run
constexpr double allowed = 1e-3;    ///< distance from the loose run, of the size
constexpr double allowed_contact = 5e-2;
constexpr double loose_contact_step = 1e-3;  ///< [s]
constexpr int most_plausible_steps = 2000;

bool fits(const Trajectory& trajectory, std::span<const double> times, Eigen::Index particles) {
  return std::ranges::equal(trajectory.times, times) && trajectory.states.size() == times.size() &&
         std::ranges::all_of(trajectory.states, [&](const State& y) {
           return y.x.rows() == particles && y.v.rows() == particles && y.x.allFinite() && y.v.allFinite();
         });
}

void require_fitting(const Reference& reference, std::span<const double> times, Eigen::Index particles) {
  for (const Trajectory* trajectory : {&reference.trajectory, &reference.witnessed, &reference.perturbed})
    if (!fits(*trajectory, times, particles)) throw DamagedFile("its trajectories do not fit the scene");
  for (const auto* series : {&reference.error, &reference.growth})
    if (series->size() != times.size()) throw DamagedFile("it has not a number for each time");
}

void require_uncertainty(const Reference& reference, bool contact) {
  for (std::size_t k = 0; k < reference.error.size(); ++k) {
    const double distance = rms_distance(reference.trajectory.states[k].x, reference.witnessed.states[k].x);
    const double error = reference.error[k];
    if (!(contact ? error >= distance : error == distance))
      throw DamagedFile("its uncertainty is not the distance of its two trajectories");
  }
}

void require_pins(const Reference& reference, const SplitOde& ode, const State& y0, double t0, double size) {
  const State start = prescribed_start(ode, y0);
  for (std::size_t k = 0; k < reference.error.size(); ++k)
    for (const solver::Pin& pin : ode.pins) {
      const int i = pin.particle;
      const Eigen::RowVector3d place = start.x.row(i) + start.v.row(i) * (reference.trajectory.times[k] - t0);
      const Eigen::RowVector3d off = (reference.trajectory.states[k].x.row(i) - place) * pin.held;
      if (!(off.norm() <= 1e-6 * size)) throw DamagedFile("its pinned particles are not where the scene has them");
    }
}

struct Enough {};

/// A trajectory that may be shorter than requested.
Trajectory loose_run(const SplitOde& ode, const State& y0, double t0, std::span<const double> times, double size) {
  const double duration = times.back() - t0;
  solver::Options options;
  options.error_control = {tolerance, size, duration};
  solver::Integrator integrator(ode, solver::method("esdirk4"), options, y0, t0);
  Trajectory run;
  int steps = 0;
  const auto count = [&](const solver::StepReport&) {
    if (++steps > most_plausible_steps) throw Enough();
  };
  try {
    for (const double t : times) {
      if (integrate(integrator, t, duration / 8, count).outcome != solver::Outcome::success) break;
      run.times.push_back(t);
      run.states.push_back(integrator.state());
    }
  } catch (const Enough&) {  // there are enough times
  }
  return run;
}

Trajectory loose_contact_run(const SplitOde& ode, const State& y0, double t0, double first) try {
  return stepped(ode, solver::method("midpoint"), y0, t0, std::array{first}, loose_contact_step);
} catch (const ReferenceError&) {
  return {};
}

}  // namespace

void require_plausible(const Reference& reference, const SplitOde& ode, const State& y0, double t0,
                       std::span<const double> times, double size) {
  const bool contact = ode.has_contacts();
  require_fitting(reference, times, y0.x.rows());
  require_uncertainty(reference, contact);
  require_pins(reference, ode, y0, t0, size);
  const Trajectory run = contact ? loose_contact_run(ode, y0, t0, times.front()) : loose_run(ode, y0, t0, times, size);
  for (std::size_t k = 0; k < run.times.size(); ++k) {
    const double distance = rms_distance(run.states[k].x, reference.trajectory.states[k].x) / size;
    const double most = (contact ? allowed_contact : allowed) * std::max(1.0, reference.growth[k]);
    if (distance > most)
      throw DamagedFile(
          fmt::format("at t = {:g} s it is {:.2g} of the size away from where the scene moves", run.times[k], distance));
  }
}

}  // namespace drape::reference
