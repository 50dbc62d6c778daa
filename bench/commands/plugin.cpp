#include "bench/commands/plugin.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string_view>

#include "model/plugin.hpp"
#include "model/scene_file/added_forces.hpp"
#include "results/provenance.hpp"
#include "solver/added_methods.hpp"
#include "solver/base/hash.hpp"
#include "solver/base/input_file.hpp"
#include "solver/plugin.hpp"

namespace drape::bench {
namespace {

/// Throws std::invalid_argument, naming the first fact in which the builds differ.
void require_same_build(const std::string& file, std::span<const solver::BuildFact> facts,
                        std::span<const solver::BuildFact> theirs) {
  for (const solver::BuildFact& ours : facts) {
    const auto same_name = [&](const solver::BuildFact& fact) { return std::string_view(fact.name) == ours.name; };
    const auto found = std::ranges::find_if(theirs, same_name);
    const std::string_view value = found == theirs.end() ? "unknown" : found->value;
    if (value != ours.value)
      throw std::invalid_argument(fmt::format(
          "{}: expected a plugin built as this program is: {} '{}', not '{}'; build it again with its find_package(drape)",
          file, ours.name, ours.value, value));
  }
}

}  // namespace

void load_plugin(const std::string& file) {
  constexpr std::uintmax_t most_bytes = std::uintmax_t{1} << 30;
  std::string hash;
  try {
    hash = base::hash_text(base::content_of(file, most_bytes));
  } catch (const base::UnreadableFile& error) {
    throw std::invalid_argument(fmt::format("{}: {}: expected a plugin, a shared library", file, error.what()));
  }
  // Lazily: that functions are missing is less than that it is of another build.
  void* const library = dlopen(std::filesystem::absolute(file).c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (library == nullptr) throw std::invalid_argument(fmt::format("{}: cannot be loaded as a plugin: {}", file, dlerror()));
  const auto* const methods = static_cast<const solver::Plugin*>(dlsym(library, "drape_plugin"));
  const auto* const forces = static_cast<const model::ForcePlugin*>(dlsym(library, "drape_forces"));
  if (methods == nullptr && forces == nullptr)
    throw std::invalid_argument(
        fmt::format("{}: expected a library that ends in DRAPE_PLUGIN(rows) or DRAPE_FORCES(rows)", file));
  if (methods != nullptr) require_same_build(file, solver::build_facts, {methods->facts, methods->fact_count});
  if (forces != nullptr) require_same_build(file, model::build_facts, {forces->facts, forces->fact_count});
  try {
    if (methods != nullptr) solver::add_methods({methods->methods, methods->method_count});
    if (forces != nullptr) model::add_forces({forces->forces, forces->force_count}, hash);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", file, error.what()));
  }
  static int count = 0;
  results::also_made_by({fmt::format("plugin_{}", ++count),
                         fmt::format("{} {}", std::filesystem::path(file).filename().string(), hash),
                         "a plugin with methods or forces, and the hash of its file"});
}

}  // namespace drape::bench
