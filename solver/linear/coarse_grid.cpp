#include "solver/linear/coarse_grid.hpp"

#include <algorithm>

namespace drape::solver {
namespace {

/// Galerkin's product Pᵀ A P is a nine-point star. This five-point star keeps its row sums and its couplings along the grid's
/// lines, on which the diagonal couplings are lumped.
class Galerkin {
 public:
  Galerkin(const FivePoint& fine, const Coarsening& u, const Coarsening& v)
      : A_(fine),
        u_(u),
        v_(v),
        size_(u.coarse() * v.coarse()),
        free_(size_),
        sum_(size_, 0.0),
        right_(size_, 0.0),
        up_(size_, 0.0) {
    each_coarse([&](int i, int a, int b) { free_[i] = !A_.node(u_.place(a) + A_.nu * v_.place(b)).alone(); });
    add_sums();
    add_couplings();
  }

  FivePoint star() const;

 private:
  template <class F>
  void each_coarse(const F& f) const {
    for (int b = 0; b < v_.coarse(); ++b)
      for (int a = 0; a < u_.coarse(); ++a) f(a + u_.coarse() * b, a, b);
  }

  template <class F>
  void each_fine(const F& f) const {
    for (int b = 0; b < A_.nv; ++b)
      for (int a = 0; a < A_.nu; ++a) f(a + A_.nu * b, a, b);
  }

  void add_sums();
  void add_couplings();

  const FivePoint& A_;
  const Coarsening &u_, &v_;
  const int size_;
  std::vector<char> free_;  ///< whether a coarse particle has a fine one that is not pinned
  std::vector<double> sum_, right_, up_;
};

/// Pᵀ A P 1
void Galerkin::add_sums() {
  std::vector<double> one(A_.particles(), 0.0);  // P 1
  each_fine([&](int i, int a, int b) {
    if (A_.node(i).alone()) return;
    v_.parents(
        b, [&](int B, double wv) { u_.parents(a, [&](int A, double wu) { one[i] += wu * wv * free_[A + u_.coarse() * B]; }); });
  });
  each_fine([&](int i, int a, int b) {
    const FivePoint::Node& n = A_.node(i);
    if (n.alone()) return;
    double t = n.diagonal * one[i];
    if (a > 0) t -= n.left * one[i - 1];
    if (a < A_.nu - 1) t -= n.right * one[i + 1];
    if (b > 0) t -= n.down * one[i - A_.nu];
    if (b < A_.nv - 1) t -= n.up * one[i + A_.nu];
    v_.parents(b,
               [&](int B, double wv) { u_.parents(a, [&](int A, double wu) { sum_[A + u_.coarse() * B] += wu * wv * t; }); });
  });
}

void Galerkin::add_couplings() {
  const auto share = [](const Coarsening& c, int a) {  // two springs in a row whose middle is interpolated: a quarter of each
    return c.kept(a) ? 1 : 0.25;
  };
  each_fine([&](int i, int a, int b) {
    const FivePoint::Node& n = A_.node(i);
    const int A = u_.parent(a), B = v_.parent(b);
    v_.parents(b, [&](int to, double w) { right_[A + u_.coarse() * to] += w * share(u_, a) * n.right; });
    u_.parents(a, [&](int to, double w) { up_[to + u_.coarse() * B] += w * share(v_, b) * n.up; });
  });
  each_coarse([&](int i, int a, int b) {
    if (a == u_.coarse() - 1 || !free_[i] || !free_[i + 1]) right_[i] = 0;
    if (b == v_.coarse() - 1 || !free_[i] || !free_[i + u_.coarse()]) up_[i] = 0;
  });
}

FivePoint Galerkin::star() const {
  FivePoint star;
  star.nu = u_.coarse();
  star.nv = v_.coarse();
  std::vector<FivePoint::Node> line(star.nu);
  each_coarse([&](int i, int a, int b) {
    FivePoint::Node& n = line[a];
    n.left = a > 0 ? right_[i - 1] : 0;
    n.right = right_[i];
    n.down = b > 0 ? up_[i - star.nu] : 0;
    n.up = up_[i];
    n.diagonal = std::max(sum_[i], 0.0) + n.left + n.right + n.down + n.up;
    n.inverse = 1 / n.diagonal;
    if (!free_[i]) n = {.diagonal = 1, .inverse = 0, .left = 0, .right = 0, .down = 0, .up = 0};  // and so 0 after smoothing
    if (a == star.nu - 1) star.append(line);
  });
  return star;
}

}  // namespace

CoarseGrid::CoarseGrid(const FivePoint& fine) : u{fine.nu}, v{fine.nv} {
  double along_u = 0, along_v = 0;
  for (int i = 0; i < fine.particles(); ++i) {
    along_u += fine.node(i).right;
    along_v += fine.node(i).up;
  }
  u.halved = fine.nu > 2 && 4 * along_u > along_v;
  v.halved = fine.nv > 2 && (4 * along_v > along_u || !u.halved);
  A = Galerkin(fine, u, v).star();
}

}  // namespace drape::solver
