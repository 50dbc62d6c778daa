#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>

#include "bench/studies/studies.hpp"
#include "reference/theory/amplification.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"

namespace drape::bench {
namespace {

using reference::LinearMode;
using reference::Mode;
using reference::Motion;
using reference::PinnedSheet;
using solver::Method;

/// A linear mode of a sheet, for users.
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

using results::Role;
using results::Standing;

results::Verdict as_theory(bool equal, const char* agreement) {
  return results::check(equal, agreement, fmt::format("not {}", agreement));
}

const results::Verdict no_theory{Standing::open, "no theory known"};

/// What a step of the method makes of a mode, which some may fail at: then the row says why.
template <class Row, class Measure>
Row measured(Checkpoint& checkpoint, const std::string& id, Row row, const Measure& measure) {
  return checkpoint.once(fmt::format("{} {}", row.method, id), [&] {
    try {
      measure(row);
    } catch (const std::exception& error) {
      row.verdict = {Standing::open, error.what()};
    }
    return row;
  });
}

/// The running step against its characteristic polynomial.
struct Amplified {
  std::string method, mode;
  double nu, W, s;
  std::optional<double> radius, distance;
  results::Verdict verdict;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Amplified, method, mode, nu, W, s, radius, distance, verdict)

constexpr results::ColumnOf<Amplified> amplified_columns[] = {
    {"method", "method", "", "time integrator", Role::key, results::field<&Amplified::method>},
    {"mode", "mode", "", "what moves", Role::key, results::field<&Amplified::mode>},
    {"nu", "ν", "1", "h² κ: numerical stiffness of the mode, the part that the split treats implicitly", Role::key,
     results::field<&Amplified::nu>},
    {"W", "W", "1", "h² ω²", Role::quantity, results::field<&Amplified::W>},
    {"s", "h c", "1", "h times the damping rate c", Role::quantity, results::field<&Amplified::s>},
    {"radius", "|z|", "1", "largest modulus of the amplification factors", Role::quantity, results::field<&Amplified::radius>},
    {"distance", "from theory", "1",
     "largest difference of coefficients of the characteristic polynomial, over the largest coefficient", Role::error,
     results::field<&Amplified::distance>},
    {"verdict", "verdict", "", "whether the running code does what theory says", Role::verdict,
     results::field<&Amplified::verdict>},
};

std::vector<Amplified> amplification(const Method& method, bool quick, Checkpoint& checkpoint) {
  constexpr double agreement = 1e-10, far_outside = 1e3;
  std::vector<Amplified> rows;
  for (const NamedMode& named : modes_of_the_sheet())
    for (const double nu : stiffnesses(quick)) {
      const Mode mode = at_step(named.mode, std::sqrt(nu / named.mode.kappa));
      if (method.explicit_springs() && std::max(mode.W, mode.s) > far_outside) continue;  // of the limit of a single sub-step
      rows.push_back(measured(checkpoint, fmt::format("{} {}", named.name, nu),
                              Amplified{std::string(method.name), named.name, mode.nu, mode.W, mode.s, {}, {}, no_theory},
                              [&](Amplified& row) {
                                row.radius = spectral_radius(method, mode);
                                if (!reference::has_theory(method.name)) return;
                                row.distance = distance_from_theory(method, mode, mode);
                                row.verdict = as_theory(*row.distance <= agreement, "as in theory");
                              }));
    }
  return rows;
}

/// Where a method becomes unstable: bisection on the spectral radius of the running step.
struct Limit {
  std::string method;
  double share;
  std::optional<double> limit, bound;
  results::Verdict verdict;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Limit, method, share, limit, bound, verdict)

constexpr results::ColumnOf<Limit> limit_columns[] = {
    {"method", "method", "", "time integrator", Role::key, results::field<&Limit::method>},
    {"share", "ω²/κ", "1", "1 in plane, much less transversally, more than 1 with stiff explicit forces", Role::key,
     results::field<&Limit::share>},
    {"limit", "W at the limit", "1", "largest stable h² ω²; 0: none, infinite: no limit up to h ω = 1600", Role::quantity,
     results::field<&Limit::limit>},
    {"bound", "in theory", "1", "the same in closed form, at the ν of the limit", Role::quantity,
     results::field<&Limit::bound>},
    {"verdict", "verdict", "", "whether the running code does what theory says", Role::verdict,
     results::field<&Limit::verdict>},
};

std::vector<Limit> stability(const Method& method, bool, Checkpoint& checkpoint) {
  std::vector<Limit> rows;
  for (const double share : {2.5, 1.5, 1.0, 0.1, 1e-3})
    rows.push_back(measured(
        checkpoint, fmt::format("{}", share), Limit{std::string(method.name), share, {}, {}, no_theory}, [&](Limit& row) {
          const double h = reference::stability_limit(method, {1 / share, 1, 0}), W = h * h;
          row.limit = W;
          if (!reference::has_theory(method.name)) return;
          const double bound = reference::stability_bound(method.name, W / share, 0);
          row.bound = bound;
          const bool equal = std::isinf(W) ? bound > 1e6 : std::abs(W - bound) <= 1e-6 * bound || (W == 0 && bound == 0);
          row.verdict = as_theory(equal, "as in theory");
        }));
  return rows;
}

/// How transverse motion lags and is damped: figure 3.3 as numbers.
struct Artificial {
  std::string method;
  double nu;
  std::optional<double> frequency, predicted_frequency, damping, predicted_damping, inertia;
  results::Verdict verdict;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Artificial, method, nu, frequency, predicted_frequency, damping, predicted_damping, inertia,
                                   verdict)

constexpr results::ColumnOf<Artificial> artificial_columns[] = {
    {"method", "method", "", "time integrator", Role::key, results::field<&Artificial::method>},
    {"nu", "ν", "1", "h² κ", Role::key, results::field<&Artificial::nu>},
    {"frequency", "frequency", "1", "measured, over the true one", Role::quantity, results::field<&Artificial::frequency>},
    {"predicted_frequency", "predicted", "1", "the same by the artificial inertia and damping", Role::quantity,
     results::field<&Artificial::predicted_frequency>},
    {"damping", "damping", "1", "decay of the amplitude in one true period", Role::quantity,
     results::field<&Artificial::damping>},
    {"predicted_damping", "predicted", "1", "the same by the artificial inertia and damping", Role::quantity,
     results::field<&Artificial::predicted_damping>},
    {"inertia", "inertia added", "1", "over the true one", Role::quantity, results::field<&Artificial::inertia>},
    {"verdict", "verdict", "", "whether the running code does what theory says", Role::verdict,
     results::field<&Artificial::verdict>},
};

std::vector<Artificial> artificial(const Method& method, bool quick, Checkpoint& checkpoint) {
  constexpr double W = 1e-4, tolerance = 1e-3;
  std::vector<Artificial> rows;
  for (const double nu : stiffnesses(quick)) {
    if (nu < W) continue;
    const Mode mode{nu, W, 0};
    rows.push_back(measured(
        checkpoint, fmt::format("{}", nu), Artificial{std::string(method.name), nu, {}, {}, {}, {}, {}, no_theory},
        [&](Artificial& row) {
          const auto seen = measured_behaviour(method, mode), exact = exact_behaviour(mode);
          const double period = 2 * std::numbers::pi / exact.frequency;
          row.frequency = seen.frequency / exact.frequency;
          row.damping = seen.decay * period;
          if (!reference::has_theory(method.name)) return;
          const auto predicted = predicted_behaviour(method.name, mode);
          row.predicted_frequency = predicted.frequency / exact.frequency;
          row.predicted_damping = predicted.decay * period;
          row.inertia = reference::artificial(method.name, mode).inertia;
          const double distance = std::hypot(seen.frequency - predicted.frequency, seen.decay - predicted.decay);
          row.verdict = as_theory(distance <= tolerance * std::hypot(predicted.frequency, predicted.decay), "as predicted");
        }));
  }
  return rows;
}

/// A table with some rows for each method.
template <class Row, std::size_t count>
Job table_of(const char* name, const char* description, const results::ColumnOf<Row> (&columns)[count],
             std::vector<Row> (*rows_of)(const Method&, bool quick, Checkpoint&), bool quick, const Methods& methods) {
  const auto compute = [=](Checkpoint& checkpoint) {
    std::vector<Row> rows;
    checkpoint.each(methods, [&](const Method* method) {
      checkpoint.show(fmt::format("{} of {}", name, method->name));
      std::ranges::move(rows_of(*method, quick, checkpoint), std::back_inserter(rows));
      checkpoint.advance();
    });
    return rows;
  };
  const auto present = [=, &columns](const std::vector<Row>& rows) {
    return results::make_table(name, description, columns, rows);
  };
  return job(name, static_cast<int>(methods.size()), compute, present);
}

}  // namespace

std::vector<Job> modes(const Question& question) {
  const Methods chosen = all_or(question.methods);
  const bool quick = question.quick;
  return {table_of("amplification", "Amplification by the running code against the characteristic polynomials",
                   amplified_columns, amplification, quick, chosen),
          table_of("stability", "Largest stable W = h² ω² by bisection, for shares ω²/κ of the implicit part", limit_columns,
                   stability, quick, chosen),
          table_of("artificial", "Artificial inertia and damping of a transverse mode, h ω = 0.01, undamped",
                   artificial_columns, artificial, quick, chosen)};
}

}  // namespace drape::bench
