#include "bench/studies/field/sheets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/lag.hpp"
#include "bench/runs/run.hpp"
#include "bench/runs/samples.hpp"
#include "model/fabric.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/sundials/arkode.hpp"
#include "solver/base/largest.hpp"

namespace drape::bench {
namespace {

using solver::State;

// Ends are ten steps of 0.02 s or a multiple of that, so that the steps of the study end where errors are measured.
constexpr double medium_end = 0.4, short_end = 0.2;  ///< [s]

/// A tenth has this number of times, so that the cubic between two of them is as exact as a lag needs.
constexpr int times_a_tenth = 10;

/// Longest computation of a certified reference [s]: beyond that a sheet has errors unknown, and the study goes on.
constexpr double longest_reference = 240;

void add_hung(std::vector<FieldSheet>& all, const std::string& scene, std::initializer_list<double> dampings, int n,
              double end) {
  for (const double damping : dampings) all.push_back({scene, damping, n, end});
}

/// Those with the dampings and obstacles of their own.
void add_others(std::vector<FieldSheet>& all, int n, double end) {
  for (const char* scene : {"peer-edge", "wind", "tablecloth"}) all.push_back({scene, std::nullopt, n, end});
}

/// Times of the motion [s], every tenth of the end among them.
std::vector<double> close_times(double end) {
  constexpr int parts = 10 * times_a_tenth;
  std::vector<double> times;
  for (int k = 1; k <= parts; ++k) times.push_back(k == parts ? end : end * k / parts);
  return times;
}

template <class Value>
std::vector<Value> tenths(const std::vector<Value>& all) {
  std::vector<Value> some;
  for (std::size_t k = times_a_tenth - 1; k < all.size(); k += times_a_tenth) some.push_back(all[k]);
  return some;
}

/// Velocity Verlet at the times of a motion.
std::vector<State> verlet_states(const model::Scene& scene, const model::Cloth& cloth, const std::vector<double>& times,
                                 double fraction) {
  RunSpec spec{scene, "", &solver::method("verlet"), times.front(), {}};
  spec.options.verlet_fraction = fraction;
  Samples samples(times);
  Observer* const observers[] = {&samples};
  const solver::RunResult result = run(spec, cloth, observers).result;
  if (result.outcome != solver::Outcome::success)
    throw reference::ReferenceError("verlet: " + result.message, std::string(to_string(result.outcome)), result.last_good_time);
  return std::move(samples).states();
}

reference::Reference explicit_reference(const model::Scene& scene, const model::Cloth& cloth,
                                        const std::vector<double>& times) {
  constexpr double fraction = 0.1, rtol = 1e-7;
  reference::Reference truth;
  truth.name = "verlet", truth.witness = "arkode-erk";
  truth.trajectory = {times, verlet_states(scene, cloth, times, fraction)};
  const std::vector<State> coarse = verlet_states(scene, cloth, times, 2 * fraction);
  const reference::SolveOptions options{.rtol = rtol, .size = model::size(scene), .max_order = 4};
  truth.witnessed = reference::arkode_erk(cloth.ode, cloth.start, 0, times, options);
  for (std::size_t k = 0; k < times.size(); ++k) {
    State& y = truth.trajectory.states[k];
    y.x += (y.x - coarse[k].x) / 3;
    y.v += (y.v - coarse[k].v) / 3;
    truth.error.push_back(reference::rms_distance(y.x, truth.witnessed.states[k].x));
  }
  return truth;
}

reference::Reference certified_or_explicit(const model::Scene& scene, const model::Cloth& cloth,
                                           const std::vector<double>& times, Checkpoint& checkpoint) {
  if (cloth.ode.damping.nonZeros() == 0 && !model::has_contacts(scene)) return explicit_reference(scene, cloth, times);
  constexpr double agreement = 1e-6;
  const auto say = [&](const std::string& pace) { checkpoint.report("reference: " + pace); };
  References references(agreement, {.seconds = longest_reference, .say = say});
  return references(scene, cloth, times);
}

}  // namespace

std::string FieldSheet::label() const { return fabric.empty() ? scene : fmt::format("{}, {}", scene, fabric); }

std::string FieldSheet::name() const {
  return damping ? fmt::format("{} d={:g} n={}", label(), *damping, n) : fmt::format("{} n={}", label(), n);
}

model::Scene FieldSheet::load() const {
  std::vector<model::Override> overrides{{"grid.n", fmt::format("{}", n)}, {"end.time", fmt::format("{}", end)}};
  if (damping) overrides.push_back({"material.damping", fmt::format("{}", *damping)});
  if (!fabric.empty()) {
    const auto found = std::ranges::find(model::fabrics(), fabric, &model::Fabric::name);
    overrides.push_back({"material.fabric", fabric});
    if (found->material.tables != model::FabricTables()) overrides.push_back({"material.law", "tables"});
  }
  return model::load_scene(scene, overrides);
}

std::vector<FieldSheet> field_sheets(bool quick) {
  std::vector<FieldSheet> all;
  if (quick) {
    for (const char* scene : {"hung-edge", "hung-corners"}) add_hung(all, scene, {50, 0.5}, 5, short_end);
    add_others(all, 5, short_end);
    std::erase_if(all, [](const FieldSheet& sheet) { return sheet.scene == "wind"; });
    for (FieldSheet& sheet : all) sheet.quick = true;
    return all;
  }
  for (const char* scene : {"hung-edge", "hung-corners"}) add_hung(all, scene, {50, 5, 0.5, 0}, 20, medium_end);
  add_others(all, 20, medium_end);
  for (const char* scene : {"hung-edge", "hung-corners"}) add_hung(all, scene, {50, 5, 0.5, 0}, 40, short_end);
  add_others(all, 40, short_end);
  add_hung(all, "hung-corners", {50, 0.5}, 100, short_end);
  all.push_back({"peer-edge", std::nullopt, 100, short_end});
  return all;
}

std::vector<FieldSheet> fabric_sheets(bool quick) {
  std::vector<FieldSheet> all;
  for (const char* fabric : {"t-shirt", "denim", "tablecloth", "cotton-broad"})
    all.push_back({"hung-corners", std::nullopt, quick ? 5 : 20, quick ? short_end : medium_end, quick, fabric});
  if (quick) all.resize(1);
  return all;
}

FieldTruth field_truth(const FieldSheet& sheet, const model::Scene& scene, const model::Cloth& cloth, Checkpoint& checkpoint) {
  checkpoint.show("reference of " + sheet.name());
  FieldTruth truth;
  try {
    reference::Reference all = certified_or_explicit(scene, cloth, close_times(scene.end), checkpoint);
    truth.compared.error = tenths(all.error);
    truth.compared.trajectory = {tenths(all.trajectory.times), tenths(all.trajectory.states)};
    truth.compared.witnessed = {tenths(all.witnessed.times), tenths(all.witnessed.states)};
    truth.uncertainty = base::largest(all.error) / model::size(scene);
    truth.motion = std::move(all.trajectory);
    truth.motion.times.insert(truth.motion.times.begin(), 0);
    truth.motion.states.insert(truth.motion.states.begin(), cloth.start);
    truth.interpolation = interpolation_error(truth.motion);
  } catch (const reference::ReferenceError& error) {
    truth.missing = error.what();
  } catch (const reference::NotCertified& error) {
    truth.missing = error.what();
  }
  return truth;
}

}  // namespace drape::bench
