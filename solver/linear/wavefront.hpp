#pragma once

#include <omp.h>

#include <cstdint>
#include <vector>

#include "solver/base/threads.hpp"
#include "solver/linear/five_point.hpp"

namespace drape::solver {

/// A thread's lines [begin, end), and those on which stage s may run before the other threads are done.
struct Band {
  int begin, end;
  bool first, last;  ///< whether the band begins or ends with the grid

  bool contains(int line, int stage) const { return line >= begin + (first ? 0 : stage) && line < end - (last ? 0 : stage); }
};

/// Runs all stages over a band in one pass over memory, and adds what they return for a line to its sum. Two lines lie between
/// the stages, so that none waits for the stores of the one before.
template <class... Stages>
void wavefront_band(const Band& band, Lanes* sums, const Stages&... stages) {
  constexpr int count = sizeof...(Stages);
  for (int front = band.begin; front < band.end + 2 * (count - 1); ++front) {
    int line = front, stage = 0;
    const auto advance = [&](const auto& run) {
      if (band.contains(line, stage)) sums[line] += run(line);
      line -= 2;
      ++stage;
    };
    (advance(stages), ...);
  }
}

/// Runs the stages on the lines that the bands on both sides of `line` left out.
template <class... Stages>
void wavefront_seam(int line, Lanes* sums, const Stages&... stages) {
  int stage = 0;
  const auto fill = [&](const auto& run) {
    for (int k = line - stage; k < line + stage; ++k) sums[k] += run(k);
    ++stage;
  };
  (fill(stages), ...);
}

/// Runs stage 0, stage 1, … on all lines of a grid in one pass over memory and returns the sum of what they return: stage s on
/// line b comes after stage s − 1 on the lines b − 1, b, b + 1 and before stage s + 1 on them, so that each finds its
/// neighbours in the cache. Each thread takes a band of lines, and then a seam; each begins with an even line. Sums of lines
/// are added up in their order, so that the result is the same for any number of threads.
template <class... Stages>
Lanes wavefront(const FivePoint& A, const Stages&... stages) {
  thread_local std::vector<Lanes> memory;
  memory.assign(A.nv, Lanes::Zero());
  Lanes* const sums = memory.data();  // of this thread, for all of them
  base::in_parts(base::threads_for_lines(A.nv, A.particles()), A.nv / 2, [&](int k, std::int64_t begin, std::int64_t end) {
    const bool first = k == 0, last = end == A.nv / 2;
    const int line = 2 * static_cast<int>(begin);
    wavefront_band({line, last ? A.nv : 2 * static_cast<int>(end), first, last}, sums, stages...);
    if (first && last) return;
#pragma omp barrier
    if (!first) wavefront_seam(line, sums, stages...);
  });
  Lanes sum = Lanes::Zero();
  for (const Lanes& of_line : memory) sum += of_line;
  return sum;
}

}  // namespace drape::solver
