#include <algorithm>
#include <vector>

#include "solver/coarse_grid.hpp"
#include "solver/preconditioner.hpp"
#include "solver/sweep.hpp"

namespace drape::solver {
namespace {

/// A grid, and the residual and correction of the next coarser one.
struct Level {
  FivePoint A;
  Coarsening u, v;
  Vectors r, z;  ///< one row more than there are particles: four lanes of the last may be loaded
};

/// Calls f(coordinates of the coarse particle, weight) for those from which (a, b) is interpolated.
template <class F>
void parents(Level& level, Vectors& field, int a, int b, const F& f) {
  double* const first =
      field.data() + 3 * (level.u.parent(a) + static_cast<Eigen::Index>(level.u.coarse()) * level.v.parent(b));
  const Eigen::Index next = 3 * static_cast<Eigen::Index>(level.u.coarse());
  const bool in_u = level.u.between(a), in_v = level.v.between(b);
  const double weight = (in_u ? 0.5 : 1) * (in_v ? 0.5 : 1);
  f(first, weight);
  if (in_u) f(first + 3, weight);
  if (in_v) f(first + next, weight);
  if (in_u && in_v) f(first + next + 3, weight);
}

/// z = r / D on red nodes (a + b even), (r + what neighbours pull) / D on black ones. What then is left is on red nodes only:
/// what their neighbours pull. It goes to the coarse grid.
void smooth_down(Level& level, const Vectors& r, Vectors& z) {
  const FivePoint& A = level.A;
  level.r.setZero();
  const auto red = [&](int b) {
    with_line(A, b, [&](const auto& line) {
      for (int a = b % 2; a < A.nu; a += 2) store(z.data() + line.begin + 3 * a, line.nodes[a].inverse * line.at(r.data(), a));
    });
  };
  const auto black = [&](int b) {
    with_line(A, b, [&](const auto& line) {
      for (int a = 1 - b % 2; a < A.nu; a += 2)
        store(z.data() + line.begin + 3 * a, line.nodes[a].inverse * (line.at(r.data(), a) + line.around(z.data(), a)));
    });
  };
  const auto restricted = [&](int b) {
    with_line(A, b, [&](const auto& line) {
      for (int a = b % 2; a < A.nu; a += 2) {
        const Lanes residual = line.around(z.data(), a);
        parents(level, level.r, a, b, [&](double* coarse, double w) { store(coarse, load(coarse) + w * residual); });
      }
    });
  };
  sweep(A.nv, red, black, restricted);
}

/// Adds the coarse correction on the red nodes, for black ones depend on these only; then black and red. Returns <r, z>.
double smooth_up(Level& level, const Vectors& r, Vectors& z) {
  const FivePoint& A = level.A;
  Lanes rz = Lanes::Zero();
  const auto corrected = [&](int b) {
    with_line(A, b, [&](const auto& line) {
      for (int a = b % 2; a < A.nu; a += 2) {
        Lanes value = line.at(z.data(), a);
        parents(level, level.z, a, b, [&](const double* coarse, double w) { value += w * load(coarse); });
        store(z.data() + line.begin + 3 * a, value);
      }
    });
  };
  const auto smoothed = [&](int b, int first) {
    with_line(A, b, [&](const auto& line) {
      for (int a = first; a < A.nu; a += 2) {
        const Lanes residual = line.at(r.data(), a);
        const Lanes value = line.nodes[a].inverse * (residual + line.around(z.data(), a));
        rz += residual * value;
        store(z.data() + line.begin + 3 * a, value);
      }
    });
  };
  sweep(
      A.nv, corrected, [&](int b) { smoothed(b, 1 - b % 2); }, [&](int b) { smoothed(b, b % 2); });
  return sum(rz);
}

/// One V(1,1) cycle on a grid, with Gauss–Seidel by colours; black before red on the way up makes it symmetric. Each way takes
/// one pass over memory. Matrices that are no five-point star of a grid are left to modified incomplete Cholesky.
class Multigrid : public Preconditioner {
 public:
  void analyze(const SparseMatrix&) override {}
  Outcome factor(const SparseMatrix& A) override;
  double apply(const Vectors& r, Vectors& z) override { return cycle(0, r, z); }
  bool exact() const override { return levels_.empty() && coarsest_->exact(); }
  std::int64_t bytes() const override;

 private:
  double cycle(std::size_t k, const Vectors& r, Vectors& z);

  static constexpr int few = 2000;  ///< particles that are better solved for directly

  std::vector<Level> levels_;
  std::unique_ptr<Preconditioner> coarsest_;
  std::vector<int> coarsest_pins_;
};

bool has_springs(const FivePoint& A) {
  return std::ranges::all_of(A.nodes, [](const FivePoint::Node& n) {
    return n.diagonal > 0 && n.left >= 0 && n.right >= 0 && n.down >= 0 && n.up >= 0;
  });
}

Outcome Multigrid::factor(const SparseMatrix& A) {
  levels_.clear();
  SparseMatrix coarsest = A;
  coarsest_ = make_cholesky();
  if (A.rows() > few) {
    std::optional<FivePoint> star = five_point(A);
    if (star && has_springs(*star)) {
      while (star->particles() > few) {
        CoarseGrid coarse(*star);
        const Vectors zero = Vectors::Zero(coarse.A.particles() + 1, 3);
        levels_.push_back({std::move(*star), coarse.u, coarse.v, zero, zero});
        star = std::move(coarse.A);
      }
      coarsest = sparse(*star);
      coarsest_pins_.clear();
      for (int i = 0; i < star->particles(); ++i)
        if (star->node(i).inverse == 0) coarsest_pins_.push_back(i);
    } else {
      coarsest_ = make_modified_incomplete_cholesky();
    }
  }
  coarsest_->analyze(coarsest);
  return coarsest_->factor(coarsest);
}

double Multigrid::cycle(std::size_t k, const Vectors& r, Vectors& z) {
  if (k == levels_.size()) return coarsest_->apply(r, z);
  Level& level = levels_[k];
  smooth_down(level, r, z);
  if (k + 1 == levels_.size())
    for (const int i : coarsest_pins_) level.r.row(i).setZero();
  cycle(k + 1, level.r, level.z);
  return smooth_up(level, r, z);
}

std::int64_t Multigrid::bytes() const {
  std::int64_t bytes = coarsest_->bytes();
  for (const Level& level : levels_)
    bytes += 2 * level.A.bytes() + vector_bytes(level.A.particles(), 5) + vector_bytes(level.r.rows(), 4);
  return bytes;
}

}  // namespace

std::unique_ptr<Preconditioner> make_multigrid() { return std::make_unique<Multigrid>(); }

}  // namespace drape::solver
