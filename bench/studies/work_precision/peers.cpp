#include "bench/studies/work_precision/peers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>

#include "bench/runs/energy_guard.hpp"
#include "bench/runs/interruption.hpp"
#include "reference/sundials/arkode.hpp"
#include "reference/sundials/peer_solvers.hpp"

namespace drape::bench {
namespace {

constexpr double kept = 0.3;  ///< changes of γ that GMRES copes with without another factorisation

/// The smallest first: each search takes as many of them as there are of ours.
std::size_t number_of(Search search) { return search == Search::full ? 48 : search == Search::usual ? 31 : 12; }

PeerSetup by_steps(const char* name, double stage_tolerance, bool deduced = false) {
  const reference::Tableau& tableau = reference::tableau(name);
  const bool systems = tableau.solves_systems();
  return {.package = Code::arkode_steps,
          .newton = systems ? &reference::newton_solve("constant") : nullptr,
          .velocity_weight = 100,
          .kept_factor = kept,
          .tableau = &tableau,
          .stage_tolerance = systems ? stage_tolerance : 1e-3,
          .deduced = deduced};
}

/// Solves within limits, whatever SUNDIALS makes of what ends it.
Solved solve_within(const PeerSetup& setup, double value, double size, const model::Cloth& cloth, std::span<const double> times,
                    const Limits& limits) {
  Meter meter(limits);
  std::optional<solver::SplitOde> watched;
  if (limits.within_steps()) meter.watch(watched.emplace(cloth.ode));
  Solved solved;
  try {
    solved.states = solve_by_peer(setup, value, size, watched ? *watched : cloth.ode, cloth.start, times);
  } catch (const std::exception& error) {
    check_interruption();  // it may have been the reason
    solved.end.result = {.outcome = solver::Outcome::failed, .message = error.what()};
    if (const auto& limit = meter.reached()) solved.end.result = {.outcome = limit->outcome, .message = limit->what()};
  }
  return solved;
}

/// The energy guard on a motion as it is seen at times that divide it into equal parts.
RunEnd solve_guarded(const model::Scene& scene, const Solve& solve, int parts, const Limits& limits) {
  const model::Cloth cloth = model::compile(scene);
  std::vector<double> times;
  for (int k = 1; k <= parts; ++k) times.push_back(scene.end * k / parts);
  const auto [end, states] = solve(cloth, times, limits);
  if (!end.succeeded()) return end;
  EnergyGuardObserver guard;
  guard.begin(scene, cloth, cloth.start);
  try {
    for (std::size_t k = 0; k < states.size(); ++k) guard.observe({times[k], scene.end / parts, 0, 0, states[k], {}});
  } catch (const Ending& ending) {
    return {.result = {ending.outcome, ending.message, ending.last_good_time}};
  }
  return end;
}

}  // namespace

std::string PeerSetup::name() const {
  std::string text(to_string(package));
  if (tableau) text.append("/").append(tableau->name);
  if (newton) text.append("/").append(newton->name);
  if (!tableau) text += fmt::format(" order {}", order);
  if (newton && tableau) text += fmt::format(" to {:.0e}", stage_tolerance);
  if (velocity_weight != 1) text += fmt::format(", velocities x{:g}", velocity_weight);
  if (kept_factor == kept && !tableau) text += ", factor kept";
  if (deduced) text += ", deduced";
  if (nonlinear > 0) text += fmt::format(", nonlinear {:g}", nonlinear);
  return text;
}

std::string advised_peer() { return PeerSetup{Code::cvode_bdf, &reference::newton_solve("constant-gmres")}.name(); }

std::vector<solver::State> solve_by_peer(const PeerSetup& setup, double value, double size, const solver::SplitOde& ode,
                                         const solver::State& start, std::span<const double> times) {
  reference::SolveOptions options{.rtol = value, .size = size, .max_order = setup.order};
  if (setup.newton) options.newton = setup.newton;
  options.tuning = {.velocity_weight = setup.velocity_weight, .kept_factor = setup.kept_factor, .nonlinear = setup.nonlinear};
  if (!setup.tableau) return reference::peer_solver(to_string(setup.package)).solve(ode, start, 0, times, options).states;
  options.rtol = setup.stage_tolerance;
  options.tuning.max_iterations = 60;  // far from the solution the constant matrix converges slowly
  options.tuning.step = value;
  options.tuning.deduced = setup.deduced;
  options.tuning.tableau = setup.tableau;
  return reference::arkode_steps(ode, start, 0, times, options).states;
}

std::vector<PeerSetup> peer_setups(Search search) {
  constexpr Code cvode = Code::cvode_bdf, adams = Code::cvode_adams, esdirk = Code::arkode_esdirk, imex = Code::arkode_imex,
                 erk = Code::arkode_erk, ida = Code::ida_bdf;
  const auto *gmres = &reference::newton_solve("constant-gmres"), *constant = &reference::newton_solve("constant"),
             *newton = &reference::newton_solve("newton"), *newton_gmres = &reference::newton_solve("newton-gmres"),
             *klu = &reference::newton_solve("klu");
  std::vector<PeerSetup> all{
      {cvode, gmres},
      {cvode, klu},
      {esdirk, klu},
      {imex, constant, 5},
      {ida, gmres},
      by_steps("midpoint", 1e-3),
      by_steps("midpoint", 1e-2),
      {cvode, gmres, 5, 100, kept},
      by_steps("knoth-wolke", 0),
      by_steps("ars-122", 1e-3),
      {adams, nullptr, 12},
      {erk, nullptr, 4},
      // the usual search goes on
      {cvode, gmres, 5, 1, kept},
      {cvode, gmres, 5, 10, kept},
      {cvode, gmres, 5, 1000, kept},
      {cvode, gmres, 2},
      {cvode, constant},
      {cvode, constant, 5, 100},
      {cvode, newton},
      {cvode, newton_gmres},
      by_steps("midpoint", 1e-4),
      by_steps("sdirk-2", 1e-3),
      by_steps("esdirk-4", 1e-4),
      by_steps("ars-222", 1e-3),
      by_steps("zonneveld", 0),
      by_steps("dormand-prince", 0),
      {esdirk, gmres},
      {esdirk, gmres, 3, 100, kept},
      {imex, constant, 3, 100},
      {ida, gmres, 5, 100, kept},
      {ida, constant},
      // the full search goes on
      {cvode, gmres, 2, 100, kept},
      {cvode, gmres, 5, 100, kept, 0.5},
      {cvode, constant, 2, 100},
      {cvode, newton, 5, 100},
      {cvode, newton_gmres, 5, 100},
      {adams, nullptr, 12, 100},
      {ida, newton_gmres, 5, 100},
      {esdirk, gmres, 5, 100, kept},
      {esdirk, constant, 3, 100},
      {erk, nullptr, 5, 100},
      by_steps("midpoint", 1e-1),
      by_steps("trbdf2", 1e-3),
      by_steps("esdirk-3", 1e-3),
      by_steps("esdirk-5", 1e-4),
      by_steps("ars-443", 1e-3),
      by_steps("midpoint", 1e-3, true),
      by_steps("fehlberg-8", 0),
  };
  all.resize(std::min(all.size(), number_of(search)));
  return all;
}

Configuration peer_configuration(const PeerSetup& setup, const model::Scene& scene, Search search) {
  const bool steps = setup.tableau != nullptr;
  Configuration all{setup.name(), setup.package, steps ? Control::step : Control::tolerance, nullptr};
  auto values = steps ? divided_steps(scene.end, finest_parts(search)) : tolerances(search == Search::quick ? 4 : 9);
  if (steps) values.erase(values.begin());  // it ends its steps at all tenths
  constexpr int looks = 100;
  for (const double value : values) {
    const Solve solve = [setup, value, size = model::size(scene)](const model::Cloth& cloth, std::span<const double> times,
                                                                  const Limits& limits) {
      return solve_within(setup, value, size, cloth, times, limits);
    };
    const int parts = steps ? static_cast<int>(std::lround(scene.end / value)) : looks;
    all.variants.push_back(
        {value, solve, [solve, scene, parts](const Limits& limits) { return solve_guarded(scene, solve, parts, limits); }});
  }
  return all;
}

void add_peers(std::vector<Configuration>& all, const model::Scene& scene, Search search) {
  for (const PeerSetup& setup : peer_setups(search)) all.push_back(peer_configuration(setup, scene, search));
}

}  // namespace drape::bench
