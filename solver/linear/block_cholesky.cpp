#include "solver/linear/block_cholesky.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <new>
#include <utility>
#include <vector>

#include "solver/base/threads.hpp"
#include "solver/linear/cholmod_view.hpp"
#include "solver/linear/pattern_cache.hpp"

namespace drape::solver {
namespace {

constexpr int tile = 96;              ///< columns of an update that one thread computes
constexpr double least_branch = 2e5;  ///< multiplications that pay for a task
constexpr int branches = 32;          ///< for each thread, about as many tasks
constexpr double as_particle = 25;    ///< multiplications that take as long as the forces on a particle

/// The pattern of blocks as CHOLMOD has lower triangles.
class BlockPattern {
 public:
  explicit BlockPattern(const SparseMatrix& A) : start_{0} {
    const auto n = static_cast<int>(A.rows()) / 3;
    for (int i = 0; i < n; ++i) {
      const auto first = std::ssize(block_);
      block_.push_back(i);
      for (int row = 3 * i; row < 3 * i + 3; ++row)
        for (SparseMatrix::InnerIterator a(A, row); a; ++a) block_.push_back(static_cast<int>(a.col()) / 3);
      std::sort(block_.begin() + first, block_.end());
      block_.erase(std::unique(block_.begin() + first, block_.end()), block_.end());
      start_.push_back(static_cast<int>(block_.size()));
    }
  }

  cholmod_sparse view() const { return cholmod_pattern(start_.size() - 1, start_.data(), block_.data(), block_.size()); }

 private:
  std::vector<int> start_, block_;
};

/// L Lᵀ of a dense matrix in its place; false if it is not positive definite.
bool factor_dense(Eigen::Ref<Eigen::MatrixXd> A) { return Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>(A).info() == Eigen::Success; }

}  // namespace

/// Columns that are eliminated together. Blocks are numbered in the order of elimination, except where `order` is.
struct BlockCholesky::Front {
  int begin, blocks;                ///< its own
  int rows_begin, rows;             ///< in the plan's rows: those of its panel, its own first
  std::int64_t panel;               ///< in values_: 3 rows × 3 blocks numbers, column by column
  std::vector<int> children = {};   ///< ascending
  std::vector<int> in_parent = {};  ///< where the parent has the rows that are not its own
  int first = 0;                    ///< of its descendants, which precede it one after the other
  double work = 0;                  ///< multiplications, descendants included

  int own() const { return 3 * blocks; }
  int rest() const { return 3 * (rows - blocks); }
  std::int64_t update_size() const { return std::int64_t{rest()} * rest(); }
};

class BlockCholesky::Plan {
 public:
  explicit Plan(const SparseMatrix& A) {
    order_blocks(A);
    plant();
    find_places(A);
  }

  std::vector<int> order;  ///< the k-th block to be eliminated
  std::vector<Front> fronts;
  std::vector<int> roots;
  std::vector<int> rows;
  std::vector<std::int64_t> places;  ///< in values_, of A's values
  std::int64_t values = 0;
  double work = 0;  ///< multiplications

 private:
  void order_blocks(const SparseMatrix& A);
  std::vector<int> fronts_of_blocks() const;
  void plant();
  void find_places(const SparseMatrix& A);
};

/// By CHOLMOD, which joins columns where their patterns are nearly the same.
void BlockCholesky::Plan::order_blocks(const SparseMatrix& A) {
  BlockPattern pattern(A);
  cholmod_common common;
  cholmod_start(&common);
  common.supernodal = CHOLMOD_SUPERNODAL;
  common.print = 0;
  cholmod_sparse view = pattern.view();
  cholmod_factor* factor = cholmod_analyze(&view, &common);
  if (factor == nullptr) {
    cholmod_finish(&common);
    throw std::bad_alloc();
  }
  const int *const begin = static_cast<int*>(factor->super), *const row_begin = static_cast<int*>(factor->pi);
  for (int k = 0; k < static_cast<int>(factor->nsuper); ++k) {
    fronts.push_back({.begin = begin[k],
                      .blocks = begin[k + 1] - begin[k],
                      .rows_begin = row_begin[k],
                      .rows = row_begin[k + 1] - row_begin[k],
                      .panel = values});
    values += std::int64_t{9} * fronts.back().rows * fronts.back().blocks;
  }
  rows.assign(static_cast<int*>(factor->s), static_cast<int*>(factor->s) + factor->ssize);
  order.assign(static_cast<int*>(factor->Perm), static_cast<int*>(factor->Perm) + factor->n);
  cholmod_free_factor(&factor, &common);
  cholmod_finish(&common);
}

std::vector<int> BlockCholesky::Plan::fronts_of_blocks() const {
  std::vector<int> front_of(order.size());
  for (int k = 0; k < std::ssize(fronts); ++k) std::fill_n(front_of.begin() + fronts[k].begin, fronts[k].blocks, k);
  return front_of;
}

/// The tree: a front's parent eliminates the first of its other rows.
void BlockCholesky::Plan::plant() {
  const std::vector<int> front_of = fronts_of_blocks();
  for (int k = 0; k < std::ssize(fronts); ++k) {
    Front& front = fronts[k];
    const auto own = rows.begin() + front.rows_begin, end = own + front.rows;
    front.first = front.children.empty() ? k : fronts[front.children.front()].first;
    front.work += 27.0 * front.blocks * front.rows * front.rows;
    if (front.rows == front.blocks) {
      roots.push_back(k);
      work += front.work;
      continue;
    }
    Front& parent = fronts[front_of[own[front.blocks]]];
    parent.children.push_back(k);
    parent.work += front.work;
    const auto parent_rows = rows.begin() + parent.rows_begin;
    std::transform(own + front.blocks, end, std::back_inserter(front.in_parent), [&](int row) {
      return static_cast<int>(std::lower_bound(parent_rows, parent_rows + parent.rows, row) - parent_rows);
    });
  }
}

void BlockCholesky::Plan::find_places(const SparseMatrix& A) {
  const std::vector<int> front_of = fronts_of_blocks();
  std::vector<int> place(order.size());
  for (int k = 0; k < std::ssize(order); ++k) place[order[k]] = k;
  places.reserve(A.nonZeros());
  for (int i = 0; i < A.outerSize(); ++i)
    for (SparseMatrix::InnerIterator a(A, i); a; ++a) {
      int column = 3 * place[i / 3] + i % 3, row = 3 * place[a.col() / 3] + static_cast<int>(a.col()) % 3;
      if (row < column) std::swap(row, column);
      const Front& front = fronts[front_of[column / 3]];
      const auto own = rows.begin() + front.rows_begin;
      const auto in_front = std::lower_bound(own, own + front.rows, row / 3) - own;
      places.push_back(front.panel + std::int64_t{3} * front.rows * (column - 3 * front.begin) + 3 * in_front + row % 3);
    }
}

BlockCholesky::BlockCholesky(const SparseMatrix& A) {
  static PatternCache<Plan> plans;
  plan_ = plans.of(A, [&] { return std::make_shared<const Plan>(A); });
  threads_ = base::threads_for(static_cast<std::int64_t>(plan_->work / as_particle));
  least_branch_ = threads_ == 1 ? INFINITY : std::max(least_branch, plan_->work / (branches * threads_));
  values_.resize(plan_->values);
  place_updates();
  solution_.resize(A.rows());
  below_.resize(A.rows());
}

/// A front's update comes first, then what its children need: one after the other, each over what the one before has left; or,
/// if they may be eliminated at the same time, beside each other.
void BlockCholesky::place_updates() {
  const std::vector<Front>& fronts = plan_->fronts;
  std::vector<std::int64_t> needed(fronts.size());
  const auto place = [&](const std::vector<int>& children, bool is_beside, std::int64_t begin) {
    std::int64_t end = begin;
    for (const int child : children) {
      updates_at_[child] = begin;
      end = std::max(end, begin + needed[child]);
      begin += is_beside ? needed[child] : fronts[child].update_size();
    }
    return end;
  };
  updates_at_.resize(fronts.size());
  for (int k = 0; k < std::ssize(fronts); ++k)
    needed[k] = place(fronts[k].children, is_task(fronts[k]), fronts[k].update_size());
  updates_.resize(place(plan_->roots, threads_ > 1, 0));
  for (int k = static_cast<int>(std::ssize(fronts)) - 1; k >= 0; --k)
    place(fronts[k].children, is_task(fronts[k]), updates_at_[k] + fronts[k].update_size());
}

bool BlockCholesky::is_task(const Front& front) const { return front.work >= least_branch_; }

BlockCholesky::Panel BlockCholesky::update(int front) {
  const int rest = plan_->fronts[front].rest();
  return {updates_.data() + updates_at_[front], rest, rest};
}

BlockCholesky::Panel BlockCholesky::panel(const Front& front) {
  return {values_.data() + front.panel, 3 * front.rows, 3 * front.blocks};
}

BlockCholesky::ConstPanel BlockCholesky::panel(const Front& front) const {
  return {values_.data() + front.panel, 3 * front.rows, 3 * front.blocks};
}

bool BlockCholesky::factor(const SparseMatrix& A) {
  values_.setZero();
  for (std::size_t k = 0; k < plan_->places.size(); ++k) values_[plan_->places[k]] = A.valuePtr()[k];
  is_definite_ = true;
#pragma omp parallel num_threads(threads_) if (threads_ > 1)
#pragma omp single
  for (const int root : plan_->roots) {
#pragma omp task
    eliminate_branch(root);
  }
  return is_definite_;
}

void BlockCholesky::eliminate_branch(int front) {
  if (!is_task(plan_->fronts[front])) {
    for (int k = plan_->fronts[front].first; k <= front; ++k) eliminate(k);
    return;
  }
  for (const int child : plan_->fronts[front].children) {
#pragma omp task
    eliminate_branch(child);
  }
#pragma omp taskwait
  eliminate(front);
}

void BlockCholesky::eliminate(int k) {
  const Front& front = plan_->fronts[k];
  const int own = front.own(), rest = front.rest();
  Panel taken = update(k);
  taken.setZero();
  for (const int child : front.children) add_update(child, front, taken);
  if (!is_definite_) return;
  Panel all = panel(front);
  if (!factor_dense(all.topRows(own))) is_definite_ = false;
  auto below = all.bottomRows(rest);
  const auto pivots = all.topRows(own).transpose().triangularView<Eigen::Upper>();
  const auto tiles = static_cast<unsigned>((rest + tile - 1) / tile);
#pragma omp taskloop grainsize(1) default(shared) if (tiles > 1)
  for (unsigned j = 0; j < tiles; ++j) {
    const int begin = static_cast<int>(j) * tile;
    auto rows = below.middleRows(begin, std::min(tile, rest - begin));
    pivots.solveInPlace<Eigen::OnTheRight>(rows);
  }
#pragma omp taskloop grainsize(1) default(shared) if (tiles > 1)
  for (unsigned j = 0; j < tiles; ++j) {
    const int begin = static_cast<int>(j) * tile, size = std::min(tile, rest - begin), left = rest - begin - size;
    const auto rows = below.middleRows(begin, size);
    taken.block(begin, begin, size, size).selfadjointView<Eigen::Lower>().rankUpdate(rows, -1);
    taken.block(begin + size, begin, left, size).noalias() -= below.bottomRows(left) * rows.transpose();
  }
}

/// Adds what a child takes off the columns of its parent, and off those of the parent's parents.
void BlockCholesky::add_update(int child, const Front& parent, Panel& to_parents) {
  const std::vector<int>& to = plan_->fronts[child].in_parent;
  const Panel from = update(child);
  Panel own = panel(parent);
  for (int j = 0; j < std::ssize(to); ++j)
    for (int c = 0; c < 3; ++c) {
      const bool is_own = to[j] < parent.blocks;
      double* const column =
          is_own ? own.col(3 * to[j] + c).data() : to_parents.col(3 * (to[j] - parent.blocks) + c).data() - 3 * parent.blocks;
      const double* const values = from.col(3 * j + c).data();
      for (int i = j; i < std::ssize(to); ++i)
        for (int r = 0; r < 3; ++r) column[3 * to[i] + r] += values[3 * i + r];
    }
}

void BlockCholesky::solve(const Vectors& r, Vectors& d) const {
  for (int k = 0; k < std::ssize(plan_->order); ++k) solution_.segment<3>(3 * k) = r.row(plan_->order[k]).transpose();
  const auto in_rows = [&](const Front& front, const auto& each) {
    const int* const rows = plan_->rows.data() + front.rows_begin + front.blocks;
    for (int i = 0; i < front.rows - front.blocks; ++i) each(solution_.segment<3>(3 * rows[i]), below_.segment<3>(3 * i));
  };
  for (const Front& front : plan_->fronts) {
    const ConstPanel all = panel(front);
    auto own = solution_.segment(3 * front.begin, all.cols());
    all.topRows(all.cols()).triangularView<Eigen::Lower>().solveInPlace(own);
    below_.head(all.rows() - all.cols()).noalias() = all.bottomRows(all.rows() - all.cols()) * own;
    in_rows(front, [](auto value, auto change) { value -= change; });
  }
  for (auto front = plan_->fronts.rbegin(); front != plan_->fronts.rend(); ++front) {
    const ConstPanel all = panel(*front);
    auto own = solution_.segment(3 * front->begin, all.cols());
    in_rows(*front, [](auto value, auto copy) { copy = value; });
    own.noalias() -= all.bottomRows(all.rows() - all.cols()).transpose() * below_.head(all.rows() - all.cols());
    all.topRows(all.cols()).transpose().triangularView<Eigen::Upper>().solveInPlace(own);
  }
  d.resize(r.rows(), 3);
  for (int k = 0; k < std::ssize(plan_->order); ++k) d.row(plan_->order[k]) = solution_.segment<3>(3 * k).transpose();
}

}  // namespace drape::solver
