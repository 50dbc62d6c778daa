#include "bench/strips/problem.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "solver/methods.hpp"
#include "solver/options.hpp"

namespace drape::bench::strips {
namespace {

bool solves_systems(const Problem& problem) {
  return problem.method == "cvode-bdf" ||
         (!is_of_sundials(problem.method) && solver::method(problem.method).stages != solver::Method::Stages::none);
}

bool holds_all(const model::PinRule& rule) { return !rule.oblique() && std::ranges::count(rule.directions, true) == 3; }

}  // namespace

std::span<const std::string_view> methods() {
  static constexpr std::string_view names[] = {"verlet",         "bridson", "rkl2",     "imex-euler", "sbdf2",
                                               "implicit-euler", "bdf2",    "midpoint", "cvode-bdf",  "cvode-adams"};
  return names;
}

bool is_of_sundials(std::string_view method) { return method.starts_with("cvode"); }

void check(const Problem& problem, const model::Scene& scene) {
  const auto require = [](bool right, const std::string& what) {
    if (!right) throw std::invalid_argument("problem.json: " + what);
  };
  require(std::ranges::find(methods(), problem.method) != methods().end(),
          fmt::format("method: expected one of {}, not '{}'", fmt::join(methods(), ", "), problem.method));
  require(problem.step > 0 && std::isfinite(problem.step), fmt::format("step: expected seconds, not {:g}", problem.step));
  require(problem.steps > 0, fmt::format("steps: expected a positive number, not {}", problem.steps));
  require(problem.stage_solver == "anderson" || problem.stage_solver == "fixed-point",
          fmt::format("stage_solver: expected anderson or fixed-point, not '{}'", problem.stage_solver));
  require(problem.tolerance > 0 && problem.tolerance < 1,
          fmt::format("tolerance: expected a number between 0 and 1, not {:g}", problem.tolerance));
  require(!solves_systems(problem) || std::ranges::all_of(scene.pins, holds_all),
          fmt::format("method: {} expects pins that hold all directions", problem.method));
}

}  // namespace drape::bench::strips
