#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "solver/partition.hpp"

namespace drape::solver {

/// Detects that explicit sub-steps τ have left their stability limit, from accelerations that they compute anyway.
///
/// For an oscillation |a₋ − 2a + a₊| = (ωτ)² |a| of three in a row: at most 4 |a| within the limit, for any sum of modes. A
/// mode outside of it alternates and grows until it dominates the accelerations, long before it is noticeable in positions,
/// where it is τ²/4 times as large. Modes of large damping that alternate and decay do not count.
class LimitWatch {
 public:
  /// Adds the next force and returns whether modes alternate and grow; weight: 1/m, 0 for pinned coordinates.
  bool alarmed(const Vectors& f, const Vectors& weight, const Partition& all) {
    const int place = place_++;
    if (place < 0 || place > 2) {
      if (place >= period) place_ = 0;
      return false;
    }
    const auto squared = [&](const Vectors& a) { return (all.own(weight).array() * all.own(a).array().square()).sum(); };
    if (place == 0) {
      differences_ = f;
      first_ = squared(f);
    } else if (place == 1) {
      differences_ -= 2 * f;
      second_ = squared(f);
    } else {
      differences_ += f;
      std::array sums{first_, second_, squared(f), squared(differences_)};  // in one reduction
      all.add_up(sums);
      const auto [first, second, third, differences] = sums;
      return third > first && differences > nearly * nearly * 16 * second;
    }
    return false;
  }

  /// Pauses after a false alarm, twice as long every time.
  void rest() { place_ = -(rest_ *= 2); }

 private:
  static constexpr int period = 8;        ///< number of accelerations of which three are examined
  static constexpr double nearly = 0.95;  ///< of 4: other modes make it less

  Vectors differences_;
  double first_ = 0, second_ = 0;
  int place_ = 0, rest_ = 1000;
};

/// Detects that neighbours have moved apart, which makes sheets stiffer, before modes leave the limit.
class StretchWatch {
 public:
  /// Sets the lengths for later comparisons; neighbours are those coupled by K.
  void begin(const SparseMatrix& K, const Vectors& x) {
    squares_.clear();
    visit(K, x, [&](double square) { squares_.push_back(square); });
  }

  /// Whether any length has grown by a tenth.
  bool stretched(const SparseMatrix& K, const Vectors& x, const Partition& all) const {
    bool any = false;
    std::size_t k = 0;
    visit(K, x, [&](double square) { any |= square > much * much * squares_[k++]; });
    return all.any(any);
  }

 private:
  static constexpr double much = 1.1;

  template <class Each>
  static void visit(const SparseMatrix& K, const Vectors& x, const Each& each) {
    for (int i = 0; i < K.outerSize(); ++i)
      for (SparseMatrix::InnerIterator entry(K, i); entry; ++entry)
        if (entry.col() > i) each((x.row(entry.col()) - x.row(i)).squaredNorm());
  }

  std::vector<double> squares_;
};

}  // namespace drape::solver
