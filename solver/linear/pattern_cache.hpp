#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "solver/state.hpp"

namespace drape::solver {

/// Analyses of patterns asked for in this process.
struct PatternCounts {
  std::int64_t computed = 0, shared = 0;
};

/// Threads may ask at the same time.
PatternCounts pattern_counts();

namespace detail {

void count_pattern(bool is_shared);

}  // namespace detail

/// Whether the rows of A, which are compressed, start at these entries and have these columns.
template <class Index, class Matrix>
bool has_pattern(const Matrix& A, std::span<const Index> start, std::span<const Index> column) {
  return std::cmp_equal(start.size(), A.rows() + 1) && std::cmp_equal(column.size(), A.nonZeros()) &&
         std::equal(start.begin(), start.end(), A.outerIndexPtr()) &&
         std::equal(column.begin(), column.end(), A.innerIndexPtr());
}

/// What follows from the pattern of a matrix alone, such as its ordering: runs of a sweep have few patterns, and each of the
/// last ones is analysed once in a process. An analysis is never changed, so that results do not depend on who asked first.
template <class Analysis, class Index = int>
class PatternCache {
 public:
  /// That of A, whose rows are compressed, by compute() if A's pattern is not among the last ones. compute() returns a
  /// std::shared_ptr<const Analysis>; what it throws is passed on.
  template <class Compute>
  std::shared_ptr<const Analysis> of(const Eigen::SparseMatrix<double, Eigen::RowMajor, Index>& A, const Compute& compute) {
    const std::lock_guard lock(mutex_);
    const auto known = std::find_if(last_.begin(), last_.end(),
                                    [&](const Entry& entry) { return has_pattern<Index>(A, entry.start, entry.column); });
    detail::count_pattern(known != last_.end());
    if (known != last_.end()) {
      std::rotate(last_.begin(), known, known + 1);
    } else {
      Entry entry{{A.outerIndexPtr(), A.outerIndexPtr() + A.rows() + 1},
                  {A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros()},
                  compute()};
      last_.insert(last_.begin(), std::move(entry));
      last_.resize(std::min(last_.size(), kept));
    }
    return last_.front().analysis;
  }

 private:
  static constexpr std::size_t kept = 8;

  struct Entry {
    std::vector<Index> start, column;
    std::shared_ptr<const Analysis> analysis;
  };

  std::mutex mutex_;
  std::vector<Entry> last_;  ///< the latest first
};

}  // namespace drape::solver
