#pragma once

#include <omp.h>

#include <algorithm>
#include <array>
#include <utility>

#include "solver/base/threads.hpp"
#include "solver/linear/five_point.hpp"

namespace drape::solver {

/// A thread's lines [begin, end), and those on which stage s may run before the other threads are done.
struct Band {
  int begin, end;
  bool first, last;  ///< whether the band begins or ends with the grid

  bool contains(int line, int stage) const { return line >= begin + (first ? 0 : stage) && line < end - (last ? 0 : stage); }
};

/// Runs all stages over a band in one pass over memory. Two lines lie between the stages, so that none waits for the stores of
/// the one before.
template <class... Stages>
Lanes wavefront_band(const Band& band, const Stages&... stages) {
  constexpr int count = sizeof...(Stages);
  Lanes sum = Lanes::Zero();
  for (int front = band.begin; front < band.end + 2 * (count - 1); ++front) {
    int line = front, stage = 0;
    const auto advance = [&](const auto& run) {
      if (band.contains(line, stage)) sum += run(line);
      line -= 2;
      ++stage;
    };
    (advance(stages), ...);
  }
  return sum;
}

/// Runs the stages on the lines that the bands on both sides of `line` left out.
template <class... Stages>
Lanes wavefront_seam(int line, const Stages&... stages) {
  Lanes sum = Lanes::Zero();
  int stage = 0;
  const auto fill = [&](const auto& run) {
    for (int k = line - stage; k < line + stage; ++k) sum += run(k);
    ++stage;
  };
  (fill(stages), ...);
  return sum;
}

/// Runs stage 0, stage 1, … on all lines of a grid in one pass over memory and returns the sum of what they return: stage s on
/// line b comes after stage s − 1 on the lines b − 1, b, b + 1 and before stage s + 1 on them, so that each finds its
/// neighbours in the cache. Each thread takes a band of lines, and then a seam.
template <class... Stages>
Lanes wavefront(const FivePoint& A, const Stages&... stages) {
  const int threads = std::clamp(A.nv / 16, 1, base::threads_for(A.particles()));
  if (threads == 1) return wavefront_band({0, A.nv, true, true}, stages...);
  std::array<Lanes, base::max_threads> sums;
#pragma omp parallel num_threads(threads)
  {
    const int k = omp_get_thread_num(), begin = A.nv * k / threads, end = A.nv * (k + 1) / threads;
    sums[k] = wavefront_band({begin, end, k == 0, k == threads - 1}, stages...);
#pragma omp barrier
    if (k > 0) sums[k] += wavefront_seam(begin, stages...);
  }
  for (int k = 1; k < threads; ++k) sums[0] += sums[k];
  return sums[0];
}

}  // namespace drape::solver
