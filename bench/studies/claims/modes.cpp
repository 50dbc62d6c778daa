#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/studies/claims/claim.hpp"
#include "reference/theory/amplification.hpp"

/// Claims about what a method does to a linear mode, from its running step.
namespace drape::bench {
namespace {

/// Eigenvalues of amplification matrices are uncertain by this: nearly equal ones by the root of the round-off.
constexpr double round_off_of_modes = 1e-7;

double radius_of(const char* method, double nu, double W) {
  return reference::spectral_radius(solver::method(method), {.nu = nu, .W = W, .s = 0});
}

/// Growth a step of the mode that grows most, ν = 0.1 … 10⁴, where the whole stiffness is `part` of what the split makes
/// implicit.
double largest_growth(const char* method, double part) {
  double growth = -1;
  for (double nu = 0.1; nu < 2e4; nu *= 10) growth = std::max(growth, radius_of(method, nu, part * nu) - 1);
  return growth;
}

constexpr const char* imex_methods[] = {"imex-euler", "sbdf2", "imex-midpoint"};

std::vector<ClaimCase> imex_is_stable() {
  std::vector<ClaimCase> cases;
  for (const auto& [part, where] : {std::pair{1.0, "ω² = κ"}, std::pair{1e-3, "ω² = κ/1000"}, std::pair{3.0, "ω² = 3 κ"}})
    for (const char* method : imex_methods)
      cases.push_back({fmt::format("{} ({})", where, method), largest_growth(method, part), round_off_of_modes, -1,
                       2 * round_off_of_modes});
  return cases;
}

constexpr double very_stiff = 1e6;

std::vector<ClaimCase> midpoint_keeps_stiff_modes() {
  return {{"ν = 10⁶, no damping", radius_of("midpoint", very_stiff, very_stiff), round_off_of_modes, 0.999, 1.001}};
}

std::vector<ClaimCase> stiff_modes_are_damped() {
  std::vector<ClaimCase> cases;
  for (const char* method : {"implicit-euler", "bdf2"})
    cases.push_back({method, radius_of(method, very_stiff, very_stiff), round_off_of_modes, 0, 0.05});
  return cases;
}

constexpr double moderate = 0.1;  ///< W of a mode that every explicit method follows: h ω = 0.3

std::vector<ClaimCase> explicit_methods_amplify() {
  std::vector<ClaimCase> cases;
  for (const char* method : {"explicit-euler", "explicit-midpoint", "verlet", "rk4"})
    cases.push_back({method, radius_of(method, moderate, moderate) - 1, round_off_of_modes, 2 * round_off_of_modes, unbounded});
  return cases;
}

std::vector<ClaimCase> implicit_methods_damp() {
  std::vector<ClaimCase> cases;
  for (const char* method : {"implicit-euler", "bdf2", "tr-bdf2", "esdirk4", "midpoint"})
    cases.push_back({method, 1 - radius_of(method, 1, 1), round_off_of_modes, 2 * round_off_of_modes, unbounded});
  return cases;
}

/// The limit of a mode with ω = 1/s over 2/ω.
std::vector<ClaimCase> limit_does_not_know_damping(const char* method) {
  std::vector<ClaimCase> cases;
  constexpr double bisection = 1e-3;  // part of the limit, by which it is uncertain
  for (const double c : {0.0, 1.0, 10.0}) {
    const reference::LinearMode mode{.kappa = 1, .omega_squared = 1, .damping = c};
    cases.push_back(
        {fmt::format("c = {:g} ω", c), reference::stability_limit(solver::method(method), mode) / 2, bisection, 0.99, 1.01});
  }
  return cases;
}

/// Radius of very stiff modes over the one that the method is made for, to which it tends as they get stiffer.
std::vector<ClaimCase> stiff_modes_lose_what_is_prescribed() {
  std::vector<ClaimCase> cases;
  for (const auto& [method, prescribed] : {std::pair{"generalized-alpha", 0.8}, std::pair{"generalized-alpha-0.5", 0.5},
                                           std::pair{"hht", 0.9 / 1.1}, std::pair{"newmark", 1.0}})
    cases.push_back({method, radius_of(method, 1e8, 1e8) / prescribed, round_off_of_modes, 0.99, 1.01});
  return cases;
}

/// Decay a step of generalised α with ρ∞ = 0.8 over that of the α-method with 0.82, which loses less of stiff modes.
std::vector<ClaimCase> generalised_alpha_spares_slow_modes() {
  std::vector<ClaimCase> cases;
  for (const double W : {0.1, 0.3, 1.0}) {
    const double ours = 1 - radius_of("generalized-alpha", W, W), other = 1 - radius_of("hht", W, W);
    cases.push_back({fmt::format("h ω = {:.2g}", std::sqrt(W)), ours / other, 2 * round_off_of_modes / other, 0, 0.99});
  }
  return cases;
}

std::vector<ClaimCase> bridson_limit() { return limit_does_not_know_damping("bridson"); }

constexpr const char* of_thesis_2002 = "Etzmuß 2002";

constexpr Claim of_modes[] = {
    {"C-07", of_thesis_2002, "3.3.3", "IMEX methods are stable for all feasible parameters",
     "largest growth a step of a mode, ν = 0.1 to 10⁴", "1", imex_is_stable, "bench/run study modes"},
    {"C-11", of_thesis_2002, "3.4.1", "the midpoint rule does not damp stiff modes: it is not L-stable", "modulus a step", "1",
     midpoint_keeps_stiff_modes, "bench/run study modes"},
    {"C-11b", of_thesis_2002, "3.4.1", "implicit Euler and BDF(2) damp stiff modes at once", "modulus a step at ν = 10⁶", "1",
     stiff_modes_are_damped, "bench/run study modes"},
    {"C-12", of_thesis_2002, "3.4.1", "explicit methods amplify undamped motion", "growth a step at h ω = 0.3", "1",
     explicit_methods_amplify, "bench/run study modes"},
    {"E-23", of_thesis_2002, "3.4.1", "implicit methods add artificial damping", "decay a step at h ω = 1", "1",
     implicit_methods_damp, "bench/run study modes"},
    {"F-08", "Bridson, Marino, Fedkiw 2003", "", "with implicit damping only the springs limit the step", "limit over 2/ω", "1",
     bridson_limit},
    {"F-17", "Chung, Hulbert 1993", "", "ρ∞ prescribes the dissipation of stiff modes", "modulus a step over ρ∞, ν = 10⁸", "1",
     stiff_modes_lose_what_is_prescribed, "bench/run study modes --method generalized-alpha,generalized-alpha-0.5,hht,newmark"},
    {"F-17b", "Chung, Hulbert 1993", "", "generalised α damps slow modes less than the α-method", "decay over that of HHT", "1",
     generalised_alpha_spares_slow_modes, "bench/run study modes --method generalized-alpha,hht"},
};

}  // namespace

std::span<const Claim> mode_claims() { return of_modes; }

}  // namespace drape::bench
