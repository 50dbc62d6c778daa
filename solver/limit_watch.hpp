#pragma once

#include <vector>

#include "solver/state.hpp"

namespace drape::solver {

/// Notices when explicit sub-steps τ have left their stability limit, from accelerations that they compute anyway.
///
/// Of three in a row, |a₋ − 2a + a₊| = (ωτ)² |a| for an oscillation: at most 4 |a| within the limit, whatever modes add up.
/// A mode outside of it alternates and grows, so that sooner or later it is all there is in the accelerations, long before
/// it can be seen in positions, of which it then is a τ²/4. Modes of large damping that alternate and decay do not count.
class LimitWatch {
 public:
  /// Takes the next force in; weight: 1/m, 0 for pinned coordinates. Whether modes alternate and grow.
  bool alarmed(const Vectors& f, const Vectors& weight) {
    const int place = place_++;
    if (place < 0 || place > 2) {
      if (place >= period) place_ = 0;
      return false;
    }
    const auto squared = [&](const Vectors& a) { return (weight.array() * a.array().square()).sum(); };
    if (place == 0) {
      differences_ = f;
      first_ = squared(f);
    } else if (place == 1) {
      differences_ -= 2 * f;
      second_ = squared(f);
    } else {
      differences_ += f;
      return squared(f) > first_ && squared(differences_) > nearly * nearly * 16 * second_;
    }
    return false;
  }

  /// After a false alarm: rests, twice as long every time.
  void rest() { place_ = -(rest_ *= 2); }

 private:
  static constexpr int period = 8;        ///< number of accelerations of which three are examined
  static constexpr double nearly = 0.95;  ///< of 4: other modes make it less

  Vectors differences_;
  double first_ = 0, second_ = 0;
  int place_ = 0, rest_ = 1000;
};

/// Notices when neighbours have moved apart, which makes sheets stiffer, before modes leave the limit.
class StretchWatch {
 public:
  /// From now on lengths are compared with those of x; neighbours are coupled by K.
  void begin(const SparseMatrix& K, const Vectors& x) {
    squares_.clear();
    visit(K, x, [&](double square) { squares_.push_back(square); });
  }

  /// Whether any length has grown by a tenth.
  bool stretched(const SparseMatrix& K, const Vectors& x) const {
    bool any = false;
    visit(K, x, [&, k = std::size_t{0}](double square) mutable { any |= square > much * much * squares_[k++]; });
    return any;
  }

 private:
  static constexpr double much = 1.1;

  template <class Look>
  static void visit(const SparseMatrix& K, const Vectors& x, Look look) {
    for (int i = 0; i < K.outerSize(); ++i)
      for (SparseMatrix::InnerIterator entry(K, i); entry; ++entry)
        if (entry.col() > i) look((x.row(entry.col()) - x.row(i)).squaredNorm());
  }

  std::vector<double> squares_;
};

}  // namespace drape::solver
