#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>

#include "model/forces/term.hpp"
#include "model/header_hash.hpp"
#include "solver/plugin.hpp"

/// A plugin (solver/plugin.hpp) may have forces, with methods or without: a source that includes this header and ends in
///
///     DRAPE_FORCES(rows)    // rows: an array of drape::model::TermKind
namespace drape::model {

/// What a plugin with forces shows. The first two members stay as they are: they are read before it is known who has made the
/// rest.
struct ForcePlugin {
  const solver::BuildFact* facts;
  std::size_t fact_count;
  const TermKind* forces;
  std::size_t force_count;
};

/// Facts of the source that includes this, as those of the solver.
constexpr auto build_facts = [] {
  std::array<solver::BuildFact, std::size(solver::build_facts) + 1> all{};
  *std::copy(std::begin(solver::build_facts), std::end(solver::build_facts), all.begin()) = {"headers of forces", header_hash};
  return all;
}();

}  // namespace drape::model

#define DRAPE_FORCES(rows)                                                                                                    \
  extern "C" {                                                                                                                \
  extern const drape::model::ForcePlugin drape_forces __attribute__((visibility("default")));                                 \
  const drape::model::ForcePlugin drape_forces = {std::data(drape::model::build_facts), std::size(drape::model::build_facts), \
                                                  std::data(rows), std::size(rows)};                                          \
  }
