#include "solver/linear/five_point.hpp"

#include <algorithm>

#include "solver/linear/wavefront.hpp"

namespace drape::solver {
namespace {

/// The length of a line: the largest distance of an entry from the diagonal.
int line_length(const SparseMatrix& A) {
  int length = 1;
  for (int i = 0; i < A.outerSize(); ++i)
    for (SparseMatrix::InnerIterator a(A, i); a; ++a) length = std::max(length, std::abs(static_cast<int>(a.col()) - i));
  return length > 1 ? length : static_cast<int>(A.rows());
}

/// The place of entry (i, j) in the star of i; null if it has none.
double* place(FivePoint::Node& node, int i, int j, int nu) {
  if (j == i) return &node.diagonal;
  if (j == i - nu && nu > 1) return &node.down;
  if (j == i + nu && nu > 1) return &node.up;
  if (j == i - 1 && i % nu != 0) return &node.left;
  if (j == i + 1 && j % nu != 0) return &node.right;
  return nullptr;
}

bool symmetric(const FivePoint& A) {
  for (int i = 0; i < A.particles(); ++i) {
    if (i % A.nu != A.nu - 1 && A.node(i).right != A.node(i + 1).left) return false;
    if (i + A.nu < A.particles() && A.node(i).up != A.node(i + A.nu).down) return false;
  }
  return true;
}

}  // namespace

void FivePoint::append(std::span<const Node> nodes_of_line) {
  if (line.empty() || !std::ranges::equal(row(static_cast<int>(line.size()) - 1), nodes_of_line)) {
    line.push_back(static_cast<int>(nodes.size()));
    nodes.insert(nodes.end(), nodes_of_line.begin(), nodes_of_line.end());
  } else {
    line.push_back(line.back());
  }
}

std::optional<FivePoint> five_point(const SparseMatrix& A) {
  const int n = static_cast<int>(A.rows());
  FivePoint star;
  star.nu = line_length(A);
  if (n == 0 || n % star.nu != 0) return {};
  star.nv = n / star.nu;
  std::vector<FivePoint::Node> line(star.nu);
  for (int b = 0; b < star.nv; ++b) {
    for (int a = 0; a < star.nu; ++a) {
      FivePoint::Node& node = line[a] = {};
      const int i = a + star.nu * b;
      for (SparseMatrix::InnerIterator entry(A, i); entry; ++entry) {
        const int j = static_cast<int>(entry.col());
        double* const found = place(node, i, j, star.nu);
        if (found == nullptr) return {};
        *found = j == i ? entry.value() : 0 - entry.value();
      }
      node.inverse = 1 / node.diagonal;
    }
    star.append(line);
  }
  if (!symmetric(star)) return {};
  return star;
}

SparseMatrix sparse(const FivePoint& A) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < A.particles(); ++i) {
    const FivePoint::Node& n = A.node(i);
    entries.emplace_back(i, i, n.diagonal);
    if (n.left != 0) entries.emplace_back(i, i - 1, -n.left);
    if (n.right != 0) entries.emplace_back(i, i + 1, -n.right);
    if (n.down != 0) entries.emplace_back(i, i - A.nu, -n.down);
    if (n.up != 0) entries.emplace_back(i, i + A.nu, -n.up);
  }
  SparseMatrix matrix(A.particles(), A.particles());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

double update_direction(const FivePoint& A, const Vectors& z, double beta, Vectors& p, Vectors& q) {
  const Eigen::Index length = 3 * static_cast<Eigen::Index>(A.nu);
  const Lanes pq = wavefront(
      A,
      [&](int b) {
        auto line = Eigen::ArrayXd::Map(p.data() + length * b, length);
        const auto news = Eigen::ArrayXd::Map(z.data() + length * b, length);
        if (beta == 0)
          line = news;  // line may not be finite
        else
          line = news + beta * line;
        return Lanes(Lanes::Zero());
      },
      [&](int b) {
        return with_line(A, b, [&](const auto& line) {
          const double* const x = p.data();
          double* const y = q.data() + line.begin;
          Lanes sum = Lanes::Zero();
          const auto product = [&](int a) -> Lanes { return line.nodes[a].diagonal * line.at(x, a) - line.around(x, a); };
          const int last = line.nu - 1;
          for (int a = 0; a < last; ++a) {
            const Lanes value = product(a);
            sum += line.at(x, a) * value;
            Eigen::Map<Lanes>(y + 3 * a) = value;  // the next overwrites the fourth lane
          }
          const Lanes value = product(last);
          store(y + 3 * last, value);
          return Lanes(sum + line.at(x, last) * value);
        });
      });
  return sum(pq);
}

}  // namespace drape::solver
