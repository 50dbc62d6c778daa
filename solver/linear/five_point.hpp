#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "solver/linear/kernels.hpp"

namespace drape::solver {

/// A symmetric N × N matrix with the pattern of a grid's five-point star: particle (a, b) with index a + nu b is coupled to at
/// most its four neighbours. Lines with the same coefficients share them, so that a sheet's matrix stays in the cache however
/// large the sheet is.
struct FivePoint {
  /// A row: the diagonal, its inverse, and minus the couplings to the neighbours, 0 where there is none.
  struct Node {
    double diagonal, inverse, left, right, down, up;
    bool operator==(const Node&) const = default;

    bool alone() const { return left == 0 && right == 0 && down == 0 && up == 0; }
  };

  int nu = 0, nv = 0;
  std::vector<Node> nodes;  ///< of the lines that differ from the one before
  std::vector<int> line;    ///< index in `nodes` of each line's first

  int particles() const { return nu * nv; }
  std::span<const Node> row(int b) const { return {nodes.data() + line[b], static_cast<std::size_t>(nu)}; }
  const Node& node(int i) const { return nodes[line[i / nu] + i % nu]; }
  std::int64_t bytes() const { return static_cast<std::int64_t>(nodes.size() * sizeof(Node) + line.size() * sizeof(int)); }

  /// Appends the next line.
  void append(std::span<const Node> nodes_of_line);
};

/// The matrix as a five-point star; absent unless it is symmetric and has such a pattern.
std::optional<FivePoint> five_point(const SparseMatrix& A);

SparseMatrix sparse(const FivePoint& A);

/// Line b of vector fields on the grid. `border`: the first and the last two lines, where four lanes or a neighbour may lie
/// outside of the field.
template <bool border>
struct GridLine {
  const FivePoint::Node* nodes;
  int nu;
  Eigen::Index length, begin;  ///< numbers in a line, offset of the line's first

  GridLine(const FivePoint& A, int b)
      : nodes(A.row(b).data()), nu(A.nu), length(3 * static_cast<Eigen::Index>(A.nu)), begin(length * b) {}

  static Lanes lanes(const double* p) {
    if constexpr (!border) return load(p);
    Lanes all = Lanes::Zero();
    all.head<3>() = Eigen::Array3d::Map(p);
    return all;
  }

  Lanes at(const double* x, int a) const { return lanes(x + begin + 3 * a); }

  /// Sum of the neighbours' values times their couplings to node a. At the ends of a line that is not a border, the ends of the
  /// next lines are read with the coefficient 0: they must be finite.
  Lanes around(const double* x, int a) const {
    const FivePoint::Node& n = nodes[a];
    const double* const p = x + begin + 3 * a;
    const auto pull = [&](double coefficient, Eigen::Index to) {
      if (border && coefficient == 0) return Lanes(Lanes::Zero());
      return Lanes(coefficient * lanes(p + to));
    };
    return (pull(n.left, -3) + pull(n.right, 3)) + (pull(n.down, -length) + pull(n.up, length));
  }
};

/// f(line) for the GridLine of line b.
template <class F>
auto with_line(const FivePoint& A, int b, const F& f) {
  if (b == 0 || b >= A.nv - 2) return f(GridLine<true>(A, b));
  return f(GridLine<false>(A, b));
}

/// p = z + β p and q = A p in one pass. Returns <p, q>.
double update_direction(const FivePoint& A, const Vectors& z, double beta, Vectors& p, Vectors& q);

}  // namespace drape::solver
