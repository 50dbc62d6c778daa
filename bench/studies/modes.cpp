#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "bench/studies/studies.hpp"
#include "reference/theory/amplification.hpp"
#include "results/table_builder.hpp"

namespace drape::bench {
namespace {

using reference::LinearMode;
using reference::Mode;
using reference::Motion;
using reference::PinnedSheet;
using solver::Method;

/// A linear mode of a sheet, for people.
struct NamedMode {
  std::string name;
  LinearMode mode;
};

/// The gravest modes of the sheet of table 3.2, 20 × 20 particles, k = 10⁴ N/m, ρ = 1 kg/m², pinned all round and stretched.
std::vector<NamedMode> modes_of_the_sheet() {
  const auto sheet = [](double strain, double damping, double bend) {
    return PinnedSheet{.nu = 20,
                       .nv = 20,
                       .size_u = 0.8,
                       .size_v = 0.8,
                       .strain_u = strain,
                       .strain_v = strain,
                       .k1 = 1e4,
                       .k2 = 1e4,
                       .d1 = damping,
                       .d2 = damping,
                       .B1 = bend,
                       .B2 = bend};
  };
  const auto mode = [](const PinnedSheet& s, Motion motion) { return linear_mode(s, {.m = 1, .n = 1, .motion = motion}); };
  return {{"in plane", mode(sheet(0.01, 0, 0), Motion::along_u)},
          {"in plane, d = 50", mode(sheet(0.01, 50, 0), Motion::along_u)},
          {"transverse, strain 0.1", mode(sheet(0.1, 0, 0), Motion::transverse)},
          {"transverse, strain 0.001", mode(sheet(0.001, 0, 0), Motion::transverse)},
          {"transverse, strain 0.001, B = 0.01", mode(sheet(0.001, 0, 0.01), Motion::transverse)},
          {"transverse, strain 0.001, d = 50", mode(sheet(0.001, 50, 0), Motion::transverse)}};
}

std::vector<double> stiffnesses(bool quick) {
  if (quick) return {1e-2, 1e2, 1e6};
  return {1e-2, 1e-1, 1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6};
}

void add_method(results::TableBuilder& table, const Method& method) {
  table.text("method", "method", "time integrator", std::string(method.name));
}

void add_mode(results::TableBuilder& table, const std::string& name, const Mode& mode) {
  table.text("mode", "mode", "what moves", name);
  table.number("nu", "ν", "1", "h² κ: numerical stiffness of the mode, the part that the split treats implicitly", mode.nu);
  table.number("W", "W", "1", "h² ω²", mode.W);
  table.number("s", "h c", "1", "h times the damping rate c", mode.s);
}

void add_verdict(results::TableBuilder& table, const std::string& verdict) {
  table.text("verdict", "verdict", "whether the running code does what theory says", verdict);
}

constexpr const char* no_theory = "no theory known";

/// What a step of the method makes of a mode, which some may fail at: then the row says why.
template <class Measure>
void measure(results::TableBuilder& table, const Measure& fill) {
  try {
    fill();
  } catch (const std::exception& error) {
    add_verdict(table, error.what());
  }
}

/// The running step against its characteristic polynomial, mode by mode.
void amplification(results::TableBuilder& table, const Method& method, bool quick) {
  constexpr double agreement = 1e-10, far_outside = 1e3;
  for (const NamedMode& named : modes_of_the_sheet())
    for (const double nu : stiffnesses(quick)) {
      const Mode mode = at_step(named.mode, std::sqrt(nu / named.mode.kappa));
      if (method.sub_steps && std::max(mode.W, mode.s) > far_outside) continue;  // of a single sub-step
      table.row();
      add_method(table, method);
      add_mode(table, named.name, mode);
      measure(table, [&] {
        table.number("radius", "|z|", "1", "largest modulus of the amplification factors", spectral_radius(method, mode));
        if (!reference::has_theory(method.name)) return add_verdict(table, no_theory);
        const double distance = distance_from_theory(method, mode, mode);
        table.number("distance", "from theory", "1",
                     "largest difference of coefficients of the characteristic polynomial, over the largest coefficient",
                     distance);
        add_verdict(table, distance <= agreement ? "as in theory" : "NOT as in theory");
      });
    }
}

/// Where methods become unstable: bisection on the spectral radius of the running step.
void stability(results::TableBuilder& table, const Method& method, bool) {
  for (const double share : {2.5, 1.5, 1.0, 0.1, 1e-3}) {
    table.row();
    add_method(table, method);
    table.number("share", "ω²/κ", "1", "1 in plane, much less transversally, more than 1 with stiff explicit forces", share);
    measure(table, [&] {
      const double h = reference::stability_limit(method, {1 / share, 1, 0}), W = h * h;
      table.number("limit", "W at the limit", "1", "largest stable h² ω²; 0: none, infinite: no limit up to h ω = 1600", W);
      if (!reference::has_theory(method.name)) return add_verdict(table, no_theory);
      const double bound = reference::stability_bound(method.name, W / share, 0);
      table.number("bound", "in theory", "1", "the same in closed form, at the ν of the limit", bound);
      const bool equal = std::isinf(W) ? bound > 1e6 : std::abs(W - bound) <= 1e-6 * bound || (W == 0 && bound == 0);
      add_verdict(table, equal ? "as in theory" : "NOT as in theory");
    });
  }
}

/// How transverse motion lags and is damped: figure 3.3 as numbers.
void artificial(results::TableBuilder& table, const Method& method, bool quick) {
  constexpr double W = 1e-4, tolerance = 1e-3;
  for (const double nu : stiffnesses(quick)) {
    if (nu < W) continue;
    const Mode mode{nu, W, 0};
    table.row();
    add_method(table, method);
    table.number("nu", "ν", "1", "h² κ", nu);
    measure(table, [&] {
      const auto measured = measured_behaviour(method, mode), exact = exact_behaviour(mode);
      const bool known = reference::has_theory(method.name);
      const auto predicted = known ? predicted_behaviour(method.name, mode) : reference::ModeBehaviour();
      const double period = 2 * std::numbers::pi / exact.frequency;
      table.number("frequency", "frequency", "1", "measured, over the true one", measured.frequency / exact.frequency);
      if (known)
        table.number("predicted_frequency", "predicted", "1", "the same by the artificial inertia and damping",
                     predicted.frequency / exact.frequency);
      table.number("damping", "damping", "1", "decay of the amplitude in one true period", measured.decay * period);
      if (!known) return add_verdict(table, no_theory);
      table.number("predicted_damping", "predicted", "1", "the same by the artificial inertia and damping",
                   predicted.decay * period);
      table.number("inertia", "inertia added", "1", "over the true one", reference::artificial(method.name, mode).inertia);
      const double scale = std::hypot(predicted.frequency, predicted.decay);
      const double distance = std::hypot(measured.frequency - predicted.frequency, measured.decay - predicted.decay);
      add_verdict(table, distance <= tolerance * scale ? "as predicted" : "NOT as predicted");
    });
  }
}

/// A table with some rows for each method.
struct MethodTable {
  const char* name;
  const char* description;
  void (*add_rows)(results::TableBuilder& table, const Method& method, bool quick);
};

constexpr MethodTable method_tables[] = {
    {"amplification", "Amplification by the running code against the characteristic polynomials", amplification},
    {"stability", "Largest stable W = h² ω² by bisection, for shares ω²/κ of the implicit part", stability},
    {"artificial", "Artificial inertia and damping of a transverse mode, h ω = 0.01, undamped", artificial}};

results::Table compute(const MethodTable& what, bool quick, const Methods& methods, Checkpoint& checkpoint) {
  results::TableBuilder table(what.name, what.description);
  for (const Method* method : methods) {
    checkpoint.show(fmt::format("{} of {}", what.name, method->name));
    checkpoint.rows(table, std::string(method->name),
                    [&](results::TableBuilder& rows) { what.add_rows(rows, *method, quick); });
    checkpoint.advance();
  }
  return table.finish();
}

}  // namespace

std::vector<TableJob> modes(bool quick, const Methods& methods) {
  const Methods chosen = all_or(methods);
  std::vector<TableJob> jobs;
  for (const MethodTable& table : method_tables)
    jobs.push_back(
        {static_cast<int>(chosen.size()), [=](Checkpoint& checkpoint) { return compute(table, quick, chosen, checkpoint); }});
  return jobs;
}

}  // namespace drape::bench
