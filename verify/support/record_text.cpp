#include "verify/support/record_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace drape::verify {
namespace {

std::string vectors_as_text(const solver::Vectors& values) {
  return fmt::format("{}x3 {}", values.rows(), fmt::join(values.reshaped<Eigen::RowMajor>(), " "));
}

}  // namespace

std::string as_text(const results::RunRecord& run) {
  const auto& [cell, scene, scene_toml, scene_keys, overrides, plan, method, stage, linear, step, until, choice, parameters,
               stiffness, to_damping, outcome, message, last_good_time, steps, times_ms, work, state, error, motion_error,
               contact, trajectory] = run;
  std::string text = fmt::format("{}\n", fmt::join({cell, scene, scene_toml, overrides, plan, method, stage, linear}, "\n"));
  text +=
      fmt::format("{} {} {} {} {}\n{}\n{}\n", step, until, stiffness, to_damping, last_good_time, to_string(outcome), message);
  for (const auto& [key, value, unit] : scene_keys) text += fmt::format("{} {} {}\n", key, value, unit);
  for (const auto& [name, value, unit, description] : parameters)
    text += fmt::format("{} {} {} {}\n", name, value, unit, description);
  for (const auto& [t, h, updates, cg, kinetic, potential, contacts] : steps)
    text += fmt::format("{} {} {} {} {} {} {}\n", t, h, updates, cg, kinetic, potential, contacts);
  for (const auto& [name, description, count] : work) text += fmt::format("{} {} {}\n", name, description, count);
  text +=
      fmt::format("{}\n{}\n{}\n{}\n", times_ms, vectors_as_text(state.x), vectors_as_text(state.v), fmt::join(state.z, " "));
  if (choice) text += fmt::format("{} {}\n", choice->accuracy, choice->reason);
  if (contact) {
    const auto& [clearance, rise, area, reference_area] = *contact;
    text += fmt::format("{} {} {} {}\n", clearance, rise, area, reference_area);
  }
  if (motion_error) {
    const auto& [position, amplitude, relative, velocity, reference_velocity, energy, momentum, angular] = *motion_error;
    text += fmt::format("{} {} {} {} {} {} {} {}\n", position, amplitude, relative, velocity, reference_velocity, energy,
                        momentum, angular);
  }
  if (trajectory) {
    const auto& [nu, nv, panels, times, states, stretch, constraint] = *trajectory;
    text += fmt::format("{} {} {} {} {}\n", nu, nv, panels, times, constraint);
    for (const solver::State& y : states) text += fmt::format("{} {}\n", vectors_as_text(y.x), vectors_as_text(y.v));
    for (const Eigen::VectorXd& strains : stretch) text += fmt::format("{}\n", fmt::join(strains, " "));
  }
  if (!error) return text;
  const auto& [rms, maximum, reference, tolerance, reference_error, growth, energy, energy_spread, centre, centre_spread] =
      *error;
  return text + fmt::format("{} {} {} {} {} {} {} {} {} {}\n", rms, maximum, reference, tolerance, reference_error, growth,
                            energy, energy_spread, centre, centre_spread);
}

}  // namespace drape::verify
