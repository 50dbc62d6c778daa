#include "solver/counters.hpp"

#include <algorithm>
#include <stdexcept>

namespace drape::solver {

std::int64_t& Counters::counter(std::string_view name, std::string_view description) {
  const auto known = std::ranges::find(kinds_, name, &Kind::name);
  if (known != kinds_.end()) return known->count;
  return kinds_.emplace_back(Kind{std::string(name), std::string(description)}).count;
}

std::int64_t Counters::count(std::string_view name) const {
  const auto known = std::ranges::find(kinds_, name, &Kind::name);
  if (known == kinds_.end()) throw std::out_of_range("no work of the kind " + std::string(name));
  return known->count;
}

}  // namespace drape::solver
