#include "model/scene_file/added_forces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "model/scene_file/keys.hpp"
#include "solver/base/printable.hpp"
#include "solver/base/row_name.hpp"

namespace drape::model {
namespace {

using Range = ForceParameter::Range;

/// Whether keys of scenes begin with this, or are it.
bool is_taken(std::string_view key) {
  return std::ranges::any_of(scene_key_table(), [&](const SceneKey& known) {
    return known.name == key || known.name.starts_with(fmt::format("{}.", key));
  });
}

bool is_in(Range range, double value) {
  return range == Range::any || value > 0 || (range == Range::non_negative && value == 0);
}

double read_parameter(const Value& value, Range range) {
  switch (range) {
    case Range::any: return value.number();
    case Range::non_negative: return value.non_negative();
    case Range::positive: break;
  }
  return value.positive();
}

/// Throws std::invalid_argument.
void require_complete(const TermKind& row) {
  const auto refuse = [](std::string_view what) { throw std::invalid_argument(std::string(what)); };
  if (!base::is_row_name(row.name)) refuse(base::row_name_rule);
  if (std::ranges::find(term_kinds(), row.name, &TermKind::name) != term_kinds().end() ||
      is_taken(fmt::format("forces.{}", row.name)))
    refuse("there is one of this name, or a key; expected another");
  if (row.make == nullptr || row.description.empty()) refuse("expected a description and a function that makes it");
  constexpr std::size_t most = 64;
  if (row.parameters.empty() || row.parameters.size() > most)
    refuse(fmt::format("expected at least one parameter, by whose key a scene has it, and {} at most", most));
  for (auto parameter = row.parameters.begin(); parameter != row.parameters.end(); ++parameter) {
    const auto refuse_it = [&](std::string_view what) {
      refuse(fmt::format("parameter '{}': {}", base::quoted(parameter->name), what));
    };
    if (!base::is_row_name(parameter->name)) refuse_it(base::row_name_rule);
    if (std::find_if(row.parameters.begin(), parameter,
                     [&](const ForceParameter& other) { return other.name == parameter->name; }) != parameter)
      refuse_it("expected names that differ");
    if (parameter->unit.empty() || parameter->description.empty())
      refuse_it("expected a unit, 1 if it has none, and a description");
    if (!is_in(parameter->range, parameter->usual)) refuse_it("expected a usual value in its range");
  }
}

/// The key of a row's parameter.
SceneKey key_of(const TermKind& row, std::size_t place, const std::string& code) {
  static std::deque<std::string> names;  // whose texts stay where they are
  const ForceParameter& parameter = row.parameters[place];
  names.push_back(fmt::format("forces.{}.{}", row.name, parameter.name));
  const auto read = [=](const Value& value, Scene& scene) {
    std::vector<AddedForce>& added = scene.sheet.added;
    auto force = std::ranges::find(added, row.name, &AddedForce::name);
    if (force == added.end()) {
      force = added.insert(added.end(), {std::string(row.name), {}, code});
      for (const ForceParameter& any : row.parameters) force->parameters.push_back(any.usual);
    }
    force->parameters[place] = read_parameter(value, parameter.range);
  };
  const auto data = [=](const Scene& scene) -> Data {
    const auto force = std::ranges::find(scene.sheet.added, row.name, &AddedForce::name);
    if (force == scene.sheet.added.end()) return {};
    return force->parameters[place];
  };
  return {{names.back(), parameter.unit, parameter.description}, read, data};
}

}  // namespace

void add_forces(std::span<const TermKind> rows, const std::string& code) {
  for (const TermKind& row : rows) {
    try {
      require_complete(row);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("force '{}': {}", base::quoted(row.name), error.what()));
    }
    add_term_kind(row);
    for (std::size_t k = 0; k < row.parameters.size(); ++k) add_scene_key(key_of(row, k, code));
  }
}

}  // namespace drape::model
