#pragma once

#include <utility>

namespace drape::solver {

/// Calls stages(0, …), stages(1, …), … for all lines of a grid in one pass over memory: stage s on line b comes after stage s −
/// 1 on the lines b − 1, b, b + 1, and before stage s − 1 on line b + 2, so that each finds its neighbours in the cache.
template <class... Stages>
void sweep(int lines, const Stages&... stages) {
  constexpr int count = sizeof...(Stages);
  for (int front = 0; front < lines + 2 * (count - 1); ++front) {
    int b = front;
    const auto advance = [&](const auto& stage) {
      if (b >= 0 && b < lines) stage(b);
      b -= 2;
    };
    (advance(stages), ...);
  }
}

}  // namespace drape::solver
