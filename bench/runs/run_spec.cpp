#include "bench/runs/run_spec.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <span>
#include <sstream>
#include <stdexcept>

#include "model/cloth.hpp"
#include "solver/base/printable.hpp"
#include "solver/base/registry.hpp"
#include "solver/stage/stage_solver.hpp"

namespace drape::bench {
namespace {

/// More would take minutes a step.
constexpr int most_repeats = 100'000;

using Repeats = solver::Method::Repeats;

std::string expected(const solver::Method& method) {
  using Stages = solver::Method::Stages;
  if (method.repeats == Repeats::sub_steps_and_sweeps)
    return fmt::format("{}/SUB_STEPSxSWEEPS/LINEAR_SOLVER, whole numbers from 1 to {}", method.name, most_repeats);
  if (method.repeats == Repeats::sweeps)
    return fmt::format("{}/SWEEPS, a whole number from 1 to {}", method.name, most_repeats);
  if (!method.implicit()) return fmt::format("{}, it leaves no solver to choose", method.name);
  if (method.stages == Stages::linear) return fmt::format("{}/LINEAR_SOLVER, its stages are linear", method.name);
  return fmt::format("{}/STAGE_SOLVER/LINEAR_SOLVER", method.name);
}

bool begins_with_digit(std::string_view text) { return !text.empty() && text[0] >= '0' && text[0] <= '9'; }

bool set_repeats(int& repeats, std::string_view text) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), repeats);
  return error == std::errc() && end == text.data() + text.size() && repeats >= 1 && repeats <= most_repeats;
}

/// Whether the text is SWEEPS or SUB_STEPSxSWEEPS, as the method has it; sets these.
bool set_repeats(const solver::Method& method, std::string_view text, solver::Options& options) {
  solver::Options wanted = options;
  const std::size_t x = text.find('x');
  const bool both = method.repeats == Repeats::sub_steps_and_sweeps;
  if (both != (x != std::string_view::npos)) return false;
  if (both && !set_repeats(wanted.sub_steps, text.substr(0, x))) return false;
  if (!set_repeats(wanted.sweeps, both ? text.substr(x + 1) : text)) return false;
  options = wanted;
  return true;
}

/// The same text, empty if it is the usual one.
std::string repeats(const solver::Method& method, const solver::Options& options) {
  const solver::Options usual;
  const bool both = method.repeats == Repeats::sub_steps_and_sweeps;
  if (both && (options.sub_steps != usual.sub_steps || options.sweeps != usual.sweeps))
    return fmt::format("/{}x{}", options.sub_steps, options.sweeps);
  return method.repeats == Repeats::sweeps && options.sweeps != usual.sweeps ? fmt::format("/{}", options.sweeps) : "";
}

template <class Row>
bool knows(std::span<const Row> table, std::string_view name) {
  return std::ranges::find(table, name, &Row::name) != table.end();
}

/// The linear solver that is named where a stage solver may be named as well.
const solver::LinearSolver& linear_or_stage_solver(std::string_view name) {
  if (knows(solver::linear_solvers(), name)) return solver::linear_solver(name);
  std::vector<std::string_view> names;
  for (const solver::LinearSolver& solver : solver::linear_solvers()) names.push_back(solver.name);
  for (const solver::StageKind& kind : solver::stage_kinds())
    if (!knows(solver::linear_solvers(), kind.name)) names.push_back(kind.name);
  throw std::invalid_argument(base::unknown_name("stage or linear solver", name, names));
}

}  // namespace

std::string RunSpec::method_name() const {
  std::string name(method->name);
  name += repeats(*method, options);
  if (method->nonlinear() && options.stage != &solver::stage_kinds().front()) name += fmt::format("/{}", options.stage->name);
  if (method->implicit() && options.linear_solver != &solver::linear_solvers().front())
    name += fmt::format("/{}", options.linear_solver->name);
  return name;
}

void choose_method(RunSpec& spec, const std::string& name) {
  std::vector<std::string> parts;
  std::istringstream stream(name);
  for (std::string part; std::getline(stream, part, '/');) parts.push_back(part);
  const std::string first = parts.empty() ? name : parts.front();
  spec.method = &solver::method(first);
  const solver::Method& method = *spec.method;
  std::size_t next = 1;
  const bool repeated = next < parts.size() && method.repeats != Repeats::none && begins_with_digit(parts[next]);
  const bool understood = !repeated || set_repeats(method, parts[next++], spec.options);
  const std::size_t solvers = next;
  if (next < parts.size() && method.nonlinear() && knows(solver::stage_kinds(), parts[next]))
    spec.options.stage = &solver::stage_kind(parts[next++]);
  if (next < parts.size() && method.implicit()) {
    const bool may_be_stage = method.nonlinear() && next == solvers;
    spec.options.linear_solver = &(may_be_stage ? linear_or_stage_solver(parts[next]) : solver::linear_solver(parts[next]));
    ++next;
  }
  if (!understood || next < parts.size() || name.ends_with('/'))
    throw std::invalid_argument(fmt::format("method '{}': expected {}", base::quoted(name), expected(method)));
}

bool alters_positions(const model::Scene& scene) {
  return !scene.obstacles.empty() && scene.contact.response == model::ResponseKind::alteration;
}

std::string reason_against(const solver::Method& method, const model::Scene& scene) {
  if (!scene.obstacles.empty() && !method.meets_obstacles) return "meets no obstacles";
  if (alters_positions(scene) && !method.implicit()) return "has no implicit equation to alter positions in";
  if (method.needs_energies)
    if (const auto forces = model::forces_without_energy(scene); !forces.empty())
      return fmt::format("needs mean forces of {}", fmt::join(forces, ", "));
  return "";
}

}  // namespace drape::bench
