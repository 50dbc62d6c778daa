#include "bench/studies/work_precision/peers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/studies/work_precision/energy.hpp"
#include "reference/distance.hpp"
#include "reference/sundials/arkode.hpp"

namespace drape::bench {
namespace {

constexpr double kept = 0.3;  ///< changes of γ that GMRES copes with without another factorisation

const std::string gmres = "constant-gmres", constant = "constant", newton = "newton", newton_gmres = "newton-gmres",
                  klu = "klu";

/// The smallest first: each search takes as many of them as there are of ours.
std::size_t number_of(Search search) { return search == Search::full ? 48 : search == Search::usual ? 31 : 12; }

PeerSetup by_steps(const std::string& tableau, double stage_tolerance, bool deduced = false) {
  const bool systems = reference::tableau(tableau).solves_systems();
  return {"arkode-steps", systems ? constant : "", 0, 100, kept, 0, tableau, systems ? stage_tolerance : 1e-3, deduced};
}

}  // namespace

std::string PeerSetup::name() const {
  std::string text = package;
  if (!tableau.empty()) text += "/" + tableau;
  if (!newton.empty()) text += "/" + newton;
  if (tableau.empty()) text += fmt::format(" order {}", order);
  if (!newton.empty() && !tableau.empty()) text += fmt::format(" to {:.0e}", stage_tolerance);
  if (velocity_weight != 1) text += fmt::format(", velocities x{:g}", velocity_weight);
  if (kept_factor == kept && tableau.empty()) text += ", factor kept";
  if (deduced) text += ", deduced";
  if (nonlinear > 0) text += fmt::format(", nonlinear {:g}", nonlinear);
  return text;
}

std::string advised_peer() { return PeerSetup{"cvode-bdf", gmres}.name(); }

std::vector<solver::State> solve_by_peer(const PeerSetup& setup, double value, double size, const model::Cloth& cloth,
                                         std::span<const double> times) {
  reference::SolveOptions options{.rtol = value, .size = size, .max_order = setup.order};
  if (!setup.newton.empty()) options.newton = &reference::newton_solve(setup.newton);
  options.tuning = {.velocity_weight = setup.velocity_weight, .kept_factor = setup.kept_factor, .nonlinear = setup.nonlinear};
  if (setup.tableau.empty())
    return reference::peer_solver(setup.package).solve(cloth.ode, cloth.start, 0, times, options).states;
  options.rtol = setup.stage_tolerance;
  options.tuning.max_iterations = 60;  // far from the solution the constant matrix converges slowly
  options.tuning.step = value;
  options.tuning.deduced = setup.deduced;
  options.tuning.tableau = &reference::tableau(setup.tableau);
  return reference::arkode_steps(cloth.ode, cloth.start, 0, times, options).states;
}

std::vector<PeerSetup> peer_setups(Search search) {
  const std::string cvode = "cvode-bdf", adams = "cvode-adams", esdirk = "arkode-esdirk", imex = "arkode-imex",
                    erk = "arkode-erk", ida = "ida-bdf";
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
      {adams, "", 12},
      {erk, "", 4},
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
      {adams, "", 12, 100},
      {ida, newton_gmres, 5, 100},
      {esdirk, gmres, 5, 100, kept},
      {esdirk, constant, 3, 100},
      {erk, "", 5, 100},
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

Family peer_family(const PeerSetup& setup, const model::Scene& scene, Search search) {
  const bool steps = !setup.tableau.empty();
  Family family{setup.name(), setup.package, steps ? "step" : "tolerance", "", {}};
  auto values = steps ? divided_steps(scene.end, finest_parts(search)) : tolerances(search == Search::quick ? 4 : 9);
  if (steps) values.erase(values.begin());  // it ends its steps at all tenths
  constexpr int looks = 100;
  for (const double value : values) {
    const States states = [setup, value, size = model::size(scene)](const model::Cloth& cloth, std::span<const double> times) {
      return solve_by_peer(setup, value, size, cloth, times);
    };
    const int parts = steps ? static_cast<int>(std::lround(scene.end / value)) : looks;
    family.candidates.push_back({value,
                                 [states](const model::Cloth& cloth, std::span<const double> times) {
                                   return reference::positions_of(states(cloth, times));
                                 },
                                 [states, scene, parts] { return energy_fault(scene, states, parts); }});
  }
  return family;
}

void add_peers(std::vector<Family>& all, const model::Scene& scene, Search search) {
  for (const PeerSetup& setup : peer_setups(search)) all.push_back(peer_family(setup, scene, search));
}

}  // namespace drape::bench
