#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace drape::base {

/// Sets of numbers from 0 on, each alone at first.
class DisjointSets {
 public:
  explicit DisjointSets(int count) : parent_(static_cast<std::size_t>(count)) { std::iota(parent_.begin(), parent_.end(), 0); }

  int count() const { return static_cast<int>(parent_.size()); }

  /// The least number of its set.
  int root(int i) {
    while (parent(i) != i) i = parent(i) = parent(parent(i));
    return i;
  }

  void join(int i, int j) {
    i = root(i), j = root(j);
    parent(std::max(i, j)) = std::min(i, j);
  }

 private:
  int& parent(int i) { return parent_[static_cast<std::size_t>(i)]; }

  std::vector<int> parent_;
};

}  // namespace drape::base
