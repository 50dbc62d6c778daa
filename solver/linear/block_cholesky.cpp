#include "solver/linear/block_cholesky.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <iterator>
#include <new>
#include <utility>

#include "solver/base/threads.hpp"
#include "solver/linear/cholmod_view.hpp"

namespace drape::solver {
namespace {

constexpr int tile = 96;              ///< columns of an update that one thread computes
constexpr double least_branch = 2e5;  ///< multiplications that pay for a task
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

BlockCholesky::BlockCholesky(const SparseMatrix& A) {
  order(A);
  plant();
  find_places(A);
  solution_.resize(A.rows());
  below_.resize(A.rows());
}

/// By CHOLMOD, which joins columns where their patterns are nearly the same.
void BlockCholesky::order(const SparseMatrix& A) {
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
  std::int64_t size = 0, updates = 0;
  for (int k = 0; k < static_cast<int>(factor->nsuper); ++k) {
    fronts_.push_back({.begin = begin[k],
                       .blocks = begin[k + 1] - begin[k],
                       .rows_begin = row_begin[k],
                       .rows = row_begin[k + 1] - row_begin[k],
                       .panel = size,
                       .update = updates});
    const Front& front = fronts_.back();
    const std::int64_t rest = 3 * (front.rows - front.blocks);
    size += std::int64_t{9} * front.rows * front.blocks;
    updates += rest * rest;
  }
  values_.resize(size);
  updates_.resize(updates);
  rows_.assign(static_cast<int*>(factor->s), static_cast<int*>(factor->s) + factor->ssize);
  order_.assign(static_cast<int*>(factor->Perm), static_cast<int*>(factor->Perm) + factor->n);
  cholmod_free_factor(&factor, &common);
  cholmod_finish(&common);
}

std::vector<int> BlockCholesky::fronts_of_blocks() const {
  std::vector<int> front_of(order_.size());
  for (int k = 0; k < std::ssize(fronts_); ++k) std::fill_n(front_of.begin() + fronts_[k].begin, fronts_[k].blocks, k);
  return front_of;
}

/// The tree: a front's parent eliminates the first of its other rows.
void BlockCholesky::plant() {
  const std::vector<int> front_of = fronts_of_blocks();
  for (int k = 0; k < std::ssize(fronts_); ++k) {
    Front& front = fronts_[k];
    const auto own = rows_.begin() + front.rows_begin, end = own + front.rows;
    front.first = front.children.empty() ? k : fronts_[front.children.front()].first;
    front.work += 27.0 * front.blocks * front.rows * front.rows;
    if (front.rows == front.blocks) {
      roots_.push_back(k);
      continue;
    }
    Front& parent = fronts_[front_of[own[front.blocks]]];
    parent.children.push_back(k);
    parent.work += front.work;
    const auto parent_rows = rows_.begin() + parent.rows_begin;
    std::transform(own + front.blocks, end, std::back_inserter(front.in_parent), [&](int row) {
      return static_cast<int>(std::lower_bound(parent_rows, parent_rows + parent.rows, row) - parent_rows);
    });
  }
}

void BlockCholesky::find_places(const SparseMatrix& A) {
  const std::vector<int> front_of = fronts_of_blocks();
  std::vector<int> place(order_.size());
  for (int k = 0; k < std::ssize(order_); ++k) place[order_[k]] = k;
  places_.reserve(A.nonZeros());
  for (int i = 0; i < A.outerSize(); ++i)
    for (SparseMatrix::InnerIterator a(A, i); a; ++a) {
      int column = 3 * place[i / 3] + i % 3, row = 3 * place[a.col() / 3] + static_cast<int>(a.col()) % 3;
      if (row < column) std::swap(row, column);
      const Front& front = fronts_[front_of[column / 3]];
      const auto rows = rows_.begin() + front.rows_begin;
      const auto in_front = std::lower_bound(rows, rows + front.rows, row / 3) - rows;
      places_.push_back(front.panel + std::int64_t{3} * front.rows * (column - 3 * front.begin) + 3 * in_front + row % 3);
    }
}

bool BlockCholesky::factor(const SparseMatrix& A) {
  values_.setZero();
  for (std::size_t k = 0; k < places_.size(); ++k) values_[places_[k]] = A.valuePtr()[k];
  is_definite_ = true;
  double work = 0;
  for (const int root : roots_) work += fronts_[root].work;
  const int threads = base::threads_for(static_cast<std::int64_t>(work / as_particle));
#pragma omp parallel num_threads(threads) if (threads > 1)
#pragma omp single
  for (const int root : roots_) {
#pragma omp task
    eliminate_branch(root);
  }
  return is_definite_;
}

void BlockCholesky::eliminate_branch(int front) {
  if (fronts_[front].work < least_branch) {
    for (int k = fronts_[front].first; k <= front; ++k) eliminate(k);
    return;
  }
  for (const int child : fronts_[front].children) {
#pragma omp task
    eliminate_branch(child);
  }
#pragma omp taskwait
  eliminate(front);
}

void BlockCholesky::eliminate(int k) {
  const Front& front = fronts_[k];
  const int own = 3 * front.blocks, rest = 3 * front.rows - own;
  Panel taken = update(front);
  taken.setZero();
  for (const int child : front.children) add_update(fronts_[child], front, taken);
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
void BlockCholesky::add_update(const Front& child, const Front& parent, Panel& to_parents) {
  const std::vector<int>& to = child.in_parent;
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
  for (int k = 0; k < std::ssize(order_); ++k) solution_.segment<3>(3 * k) = r.row(order_[k]).transpose();
  const auto in_rows = [&](const Front& front, const auto& each) {
    const int* const rows = rows_.data() + front.rows_begin + front.blocks;
    for (int i = 0; i < front.rows - front.blocks; ++i) each(solution_.segment<3>(3 * rows[i]), below_.segment<3>(3 * i));
  };
  for (const Front& front : fronts_) {
    const ConstPanel all = panel(front);
    auto own = solution_.segment(3 * front.begin, all.cols());
    all.topRows(all.cols()).triangularView<Eigen::Lower>().solveInPlace(own);
    below_.head(all.rows() - all.cols()).noalias() = all.bottomRows(all.rows() - all.cols()) * own;
    in_rows(front, [](auto value, auto change) { value -= change; });
  }
  for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) {
    const ConstPanel all = panel(*front);
    auto own = solution_.segment(3 * front->begin, all.cols());
    in_rows(*front, [](auto value, auto copy) { copy = value; });
    own.noalias() -= all.bottomRows(all.rows() - all.cols()).transpose() * below_.head(all.rows() - all.cols());
    all.topRows(all.cols()).transpose().triangularView<Eigen::Upper>().solveInPlace(own);
  }
  d.resize(r.rows(), 3);
  for (int k = 0; k < std::ssize(order_); ++k) d.row(order_[k]) = solution_.segment<3>(3 * k).transpose();
}

}  // namespace drape::solver
