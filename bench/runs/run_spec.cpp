#include "bench/runs/run_spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <sstream>
#include <stdexcept>

#include "solver/base/printable.hpp"
#include "solver/stage/stage_solver.hpp"

namespace drape::bench {
namespace {

std::string expected(const solver::Method& method) {
  using Stages = solver::Method::Stages;
  if (!method.implicit()) return fmt::format("{}, it leaves no solver to choose", method.name);
  if (method.stages == Stages::linear) return fmt::format("{}/LINEAR_SOLVER, its stages are linear", method.name);
  return fmt::format("{}/STAGE_SOLVER/LINEAR_SOLVER", method.name);
}

template <class Row>
bool knows(std::span<const Row> table, std::string_view name) {
  return std::ranges::find(table, name, &Row::name) != table.end();
}

}  // namespace

std::string RunSpec::method_name() const {
  std::string name(method->name);
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
  if (next < parts.size() && method.nonlinear() && knows(solver::stage_kinds(), parts[next]))
    spec.options.stage = &solver::stage_kind(parts[next++]);
  if (next < parts.size() && method.implicit()) spec.options.linear_solver = &solver::linear_solver(parts[next++]);
  if (next < parts.size() || name.ends_with('/'))
    throw std::invalid_argument(fmt::format("method '{}': expected {}", base::quoted(name), expected(method)));
}

}  // namespace drape::bench
