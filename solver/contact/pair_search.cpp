#include "solver/contact/pair_search.hpp"

#include <algorithm>
#include <span>

namespace drape::solver {
namespace {

/// Whether two faces have a corner in common.
bool are_neighbours(const PairContact& one, const PairContact& other) {
  return std::any_of(one.particles.begin() + 1, one.particles.end(), [&](int corner) {
    return std::find(other.particles.begin() + 1, other.particles.end(), corner) != other.particles.end();
  });
}

}  // namespace

std::vector<char> on_borders(const std::vector<PairContact>& pairs, PairContact::Points PairContact::*points) {
  std::vector<char> found(pairs.size(), false);
  for (std::size_t begin = 0, end = 0; begin < pairs.size() && !pairs[begin].edges; begin = end) {
    while (end < pairs.size() && !pairs[end].edges && pairs[end].particles[0] == pairs[begin].particles[0]) ++end;
    const std::span of_vertex(pairs.data() + begin, end - begin);
    for (std::size_t k = begin; k < end; ++k)
      found[k] = !(pairs[k].*points).is_inside() && std::ranges::any_of(of_vertex, [&](const PairContact& other) {
        return (other.*points).is_inside() && are_neighbours(pairs[k], other);
      });
  }
  return found;
}

}  // namespace drape::solver
