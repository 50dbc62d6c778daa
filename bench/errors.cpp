#include "bench/errors.hpp"

#include <fmt/format.h>

#include "bench/interruption.hpp"
#include "bench/limits.hpp"
#include "bench/motion_error.hpp"
#include "model/scene_file.hpp"
#include "solver/largest.hpp"
#include "solver/printable.hpp"

namespace drape::bench {
namespace {

using solver::State;

double centre_distance(const model::Cloth& cloth, const State& a, const State& b) {
  return (cloth.ode.mass.asDiagonal() * (a.x - b.x)).colwise().sum().norm() / cloth.ode.mass.sum();
}

reference::Reference compute_reference(const model::Cloth& cloth, const std::vector<double>& times,
                                       const reference::SolveOptions& options) {
  solver::SplitOde ode = cloth.ode;
  watch(ode, Limits().seconds);
  try {
    return ode.contacts ? reference::contact_reference(ode, cloth.start, 0, times, options)
                        : reference::reference(ode, cloth.start, 0, times, options);
  } catch (const reference::ReferenceError&) {
    check_interruption();  // it may have been the reason
    throw;
  }
}

}  // namespace

std::vector<double> compared_times(const model::Scene& scene) {
  constexpr int count = 10;
  std::vector<double> times;
  for (int k = 1; k <= count; ++k) times.push_back(scene.end * k / count);
  return times;
}

References::~References() {
  for (const std::string& message : cache_.messages()) fmt::print(stderr, "note: {}\n", solver::printable(message));
}

reference::Reference References::operator()(const model::Scene& scene, const model::Cloth& cloth) {
  return (*this)(scene, cloth, compared_times(scene));
}

reference::Reference References::operator()(const model::Scene& scene, const model::Cloth& cloth,
                                            const std::vector<double>& times) {
  const reference::SolveOptions options{.rtol = rtol_, .size = model::size(scene)};
  const auto key = reference::cache_key(model::to_toml(scene), 0, times, options);
  reference::Reference reference = reference::cached(cache_, key, [&] { return compute_reference(cloth, times, options); });
  if (cloth.ode.contacts) return reference;  // of first order: its uncertainty decides what is shown
  try {
    reference::certify(reference, agreement_, results::comparable_growth, options.size);
  } catch (const reference::NotCertified& error) {
    throw reference::NotCertified(fmt::format("{}: {}; allow more by --agreement", scene.name, error.what()));
  }
  return reference;
}

results::ErrorRecord distance(const results::RunRecord& run, const reference::Reference& reference, const model::Scene& scene,
                              const model::Cloth& cloth) {
  const double size = model::size(scene), end = reference.trajectory.times.back();
  const State &y = reference.trajectory.states.back(), &perturbed = reference.perturbed.states.back();
  const double energy = total_energy(cloth, end, y), scale = motion_scale(cloth, reference.trajectory, size).energy;
  return {.rms = reference::rms_distance(run.final_state.x, y.x) / size,
          .maximum = (run.final_state.x - y.x).rowwise().norm().maxCoeff() / size,
          .reference = fmt::format("{} + {}", reference.name, reference.witness),
          .reference_tolerance = reference.tolerance,
          .reference_error = solver::largest(reference.error) / size,
          .growth = solver::largest(reference.growth),
          .energy = std::abs(total_energy(cloth, end, run.final_state) - energy) / scale,
          .energy_spread = std::abs(total_energy(cloth, end, perturbed) - energy) / scale,
          .centre = centre_distance(cloth, run.final_state, y) / size,
          .centre_spread = centre_distance(cloth, perturbed, y) / size};
}

}  // namespace drape::bench
