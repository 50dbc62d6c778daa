#include <algorithm>
#include <vector>

#include "solver/linear/coarse_grid.hpp"
#include "solver/linear/preconditioner.hpp"
#include "solver/linear/wavefront.hpp"

namespace drape::solver {
namespace {

/// A grid, and the residual and correction of the next coarser one.
struct Level {
  FivePoint A;
  Coarsening u, v;
  Vectors r, z;  ///< one row more than there are particles: four lanes of the last may be loaded
};

/// Calls f(a, coarse, in_u, in_v) for the red nodes of line b (a + b even). `coarse`: index of the first coordinate of the
/// coarse particle at or before (a, b); in_u, in_v (constants, so that the loop has no branches): whether the node lies halfway
/// to the next one along u and along v.
template <class F>
void each_red(const Level& level, int b, const F& f) {
  const Eigen::Index first = 3 * static_cast<Eigen::Index>(level.u.coarse()) * level.v.parent(b);
  const auto loop = [&](auto in_u, auto in_v) {
    const int end = level.A.nu - 1;
    int a = b % 2;
    for (; a < end; a += 2) f(a, first + 3 * level.u.parent(a), in_u, in_v);
    if (a == end) f(a, first + 3 * level.u.parent(a), std::false_type(), in_v);
  };
  const auto along_v = [&](auto in_u) { level.v.between(b) ? loop(in_u, std::true_type()) : loop(in_u, std::false_type()); };
  level.u.halved&& b % 2 == 1 ? along_v(std::true_type()) : along_v(std::false_type());
}

/// Adds the residual on the red nodes of line b to the coarse grid.
void restrict_line(Level& level, int b, const Vectors& z) {
  const Eigen::Index next = 3 * static_cast<Eigen::Index>(level.u.coarse());
  with_line(level.A, b, [&](const auto& line) {
    Lanes carried = Lanes::Zero();  // kept in a register for the next coarse particle: storing and loading it would stall
    double* pending = nullptr;
    const auto add = [&](auto in_v, double* to, const Lanes& part) {
      store(to, load(to) + part);
      if (in_v) store(to + next, load(to + next) + part);
    };
    each_red(level, b, [&](int a, Eigen::Index coarse, auto in_u, auto in_v) {
      double* const to = level.r.data() + coarse;
      const Lanes part = (in_u ? 0.5 : 1) * (in_v ? 0.5 : 1) * line.around(z.data(), a);
      add(in_v, to, in_u ? Lanes(part + carried) : part);
      if (!in_u) return;
      carried = part;
      pending = to + 3;
    });
    if (pending != nullptr) add(level.v.between(b), pending, carried);
  });
}

/// Adds the residual on the red nodes of lines b − 1 and b to the coarse lines below and above b, which lies halfway between
/// them; rows of both lines that a coarse particle gets from below are added up first. A coarse line then gets two summands,
/// in whichever order, so that bands do not change its sums.
void restrict_pair(Level& level, int b, const Vectors& z) {
  const FivePoint& A = level.A;
  double* const below = level.r.data() + 3 * static_cast<Eigen::Index>(level.u.coarse()) * level.v.parent(b);
  double* const above = below + 3 * static_cast<Eigen::Index>(level.u.coarse());
  with_line(A, b - 1, [&](const auto& even) {
    with_line(A, b, [&](const auto& odd) {
      const auto add = [&](int coarse, const Lanes& at_even, const Lanes& at_odd) {
        store(below + 3 * coarse, load(below + 3 * coarse) + (at_even + at_odd));
        store(above + 3 * coarse, load(above + 3 * coarse) + at_odd);
      };
      const int last = A.nu - 1;
      Lanes left = Lanes::Zero();
      for (int k = 0; 2 * k + 1 < last; ++k) {
        const Lanes right = 0.25 * odd.around(z.data(), 2 * k + 1);
        add(k, even.around(z.data(), 2 * k), left + right);
        left = right;
      }
      add(last / 2, even.around(z.data(), last / 2 * 2), left);
      if (last % 2 == 1) add(last / 2 + 1, Lanes::Zero(), 0.5 * odd.around(z.data(), last));
    });
  });
}

/// z = r / D on red nodes (a + b even), then (r + couplings × neighbours) / D on black ones. The residual is then couplings ×
/// neighbours on red nodes and 0 on black ones; it is restricted to the coarse grid. A line's black ends are set to 0 first,
/// since the next lines may read them before they are computed and z may hold anything.
void smooth_down(Level& level, const Vectors& r, Vectors& z) {
  const FivePoint& A = level.A;
  level.r.setZero();
  const auto red = [&](int b) {
    with_line(A, b, [&](const auto& line) {
      for (int a = b % 2; a < A.nu; a += 2) store(z.data() + line.begin + 3 * a, line.nodes[a].inverse * line.at(r.data(), a));
      for (const int end : {0, A.nu - 1})
        if ((end + b) % 2 == 1) store(z.data() + line.begin + 3 * end, Lanes::Zero());
    });
    return Lanes(Lanes::Zero());
  };
  const auto black = [&](int b) {
    with_line(A, b, [&](const auto& line) {
      for (int a = 1 - b % 2; a < A.nu; a += 2)
        store(z.data() + line.begin + 3 * a, line.nodes[a].inverse * (line.at(r.data(), a) + line.around(z.data(), a)));
    });
    return Lanes(Lanes::Zero());
  };
  const auto in_pair = [&](int b) { return level.u.halved && level.v.between(b); };
  const auto restricted = [&](int b) {
    if (in_pair(b))
      restrict_pair(level, b, z);
    else if (!in_pair(b + 1))
      restrict_line(level, b, z);
    return Lanes(Lanes::Zero());
  };
  wavefront(A, red, black, restricted);
}

/// Adds the coarse correction on the red nodes, since black ones depend only on these; then smooths black and red. Returns <r,
/// z>.
double smooth_up(Level& level, const Vectors& r, Vectors& z) {
  const FivePoint& A = level.A;
  const Eigen::Index next = 3 * static_cast<Eigen::Index>(level.u.coarse());
  const auto corrected = [&](int b) {
    with_line(A, b, [&](const auto& line) {
      each_red(level, b, [&](int a, Eigen::Index coarse, auto in_u, auto in_v) {
        const double* const from = level.z.data() + coarse;
        Lanes part = load(from);
        if (in_u) part += load(from + 3);
        if (in_v) part += load(from + next);
        if (in_u && in_v) part += load(from + next + 3);
        store(z.data() + line.begin + 3 * a, line.at(z.data(), a) + (in_u ? 0.5 : 1) * (in_v ? 0.5 : 1) * part);
      });
    });
    return Lanes(Lanes::Zero());
  };
  const auto smoothed = [&](int b, int first) {
    Lanes rz = Lanes::Zero();
    with_line(A, b, [&](const auto& line) {
      for (int a = first; a < A.nu; a += 2) {
        const Lanes residual = line.at(r.data(), a);
        const Lanes value = line.nodes[a].inverse * (residual + line.around(z.data(), a));
        rz += residual * value;
        store(z.data() + line.begin + 3 * a, value);
      }
    });
    return rz;
  };
  const Lanes rz = wavefront(
      A, corrected, [&](int b) { return smoothed(b, 1 - b % 2); }, [&](int b) { return smoothed(b, b % 2); });
  return sum(rz);
}

/// One V(1,1) cycle on a grid, with Gauss–Seidel by colours; black before red on the way up makes it symmetric. Each way takes
/// one pass over memory. Matrices other than a five-point star of a grid are solved by modified incomplete Cholesky.
class Multigrid : public Preconditioner {
 public:
  void analyse(const SparseMatrix&) override {}
  Outcome factor(const SparseMatrix& A) override;
  double apply(const Vectors& r, Vectors& z) override { return cycle(0, r, z); }
  bool exact() const override { return levels_.empty() && coarsest_->exact(); }
  std::string_view name() const override { return levels_.empty() ? coarsest_->name() : "multigrid"; }
  std::int64_t bytes() const override;

 private:
  double cycle(std::size_t k, const Vectors& r, Vectors& z);

  static constexpr int few = 1000;  ///< particles up to which a direct solve is faster

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
  coarsest_->analyse(coarsest);
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
