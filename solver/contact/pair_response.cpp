#include "solver/contact/pair_response.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "solver/base/stopwatch.hpp"

namespace drape::solver {
namespace {

constexpr double recovery = 0.2;      ///< part of what is missing of the thickness that a pair gains in a step
constexpr double worn = 0.95;         ///< part of the thickness below which a pair is missed
constexpr double leaving = 1.5;       ///< thicknesses beyond which a pair of the step before is forgotten
constexpr int most_sweeps = 60;       ///< over all rows
constexpr double balance = 1e-4;      ///< force that may be left where rows push, over that of the residual
constexpr double settled = 0.1;       ///< the same when the sweeps end, over what may be left
constexpr double held_part = 1e-12;   ///< of the part of a row that pins and obstacles leave
constexpr double least_pivot = 1e-6;  ///< sin² of the angle between a row and the span of others that it depends on
constexpr double softening = 1e-8;    ///< over the least pivot, so that none is 0

using Compressed = Eigen::SparseMatrix<double, Eigen::RowMajor>;

auto coordinates(const Vectors& v) { return Eigen::VectorXd::Map(v.data(), v.size()); }
auto coordinates(Vectors& v) { return Eigen::VectorXd::Map(v.data(), v.size()); }

auto key(const PairContact& pair) { return std::tie(pair.edges, pair.particles); }

}  // namespace

/// W Cᵀ (C W Cᵀ)⁻¹ with a diagonal W, of the constrained rows without those that depend on others.
class PairResponse::Factor {
 public:
  Factor(const std::vector<Row>& rows, const Eigen::VectorXd& weights) : weights_(thrice(weights)) {
    for (int r = 0; r < std::ssize(rows); ++r)
      if (rows[r].active) rows_.push_back(r);
    while (!independent(rows)) {
    }
  }

  const std::vector<int>& rows() const { return rows_; }

  /// Adds W Cᵀ (C W Cᵀ)⁻¹ b to v; refined twice, since rows may be nearly dependent.
  void add(const Eigen::VectorXd& b, Vectors& v) const {
    if (rows_.empty()) return;
    Eigen::VectorXd left = b;
    for (int k = 0; k < 3; ++k) {
      const Eigen::VectorXd change = weights_.asDiagonal() * (C_.transpose() * cholesky_.solve(left)).eval();
      coordinates(v) += change;
      left -= C_ * change;
    }
  }

  /// C v
  Eigen::VectorXd along(const Vectors& v) const { return C_ * coordinates(v); }

 private:
  /// Factors the rows, and leaves out those of a small pivot: false if there are any.
  bool independent(const std::vector<Row>& rows) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int r = 0; r < std::ssize(rows_); ++r)
      for (int k = 0; k < 4; ++k)
        for (int c = 0; c < 3; ++c)
          entries.emplace_back(r, 3 * rows[rows_[r]].pair.particles[k] + c, rows[rows_[r]].direction[k][c]);
    C_.resize(std::ssize(rows_), weights_.size());
    if (rows_.empty()) return true;
    C_.setFromTriplets(entries.begin(), entries.end());
    const Compressed weighted = C_ * weights_.asDiagonal();
    Eigen::SparseMatrix<double> S = weighted * C_.transpose();
    const Eigen::VectorXd diagonal = S.diagonal();
    const double least = least_pivot * diagonal.maxCoeff();
    for (Eigen::Index r = 0; r < S.rows(); ++r) S.coeffRef(r, r) += softening * least;
    cholesky_.compute(S);
    const Eigen::VectorXd pivots = cholesky_.permutationPinv() * cholesky_.vectorD();
    std::vector<int> kept;
    for (int r = 0; r < std::ssize(rows_); ++r)
      if (pivots[r] > least_pivot * diagonal[r] && diagonal[r] > least) kept.push_back(rows_[r]);
    return std::ssize(std::exchange(rows_, std::move(kept))) == std::ssize(rows_);
  }

  std::vector<int> rows_;
  Compressed C_;
  Eigen::VectorXd weights_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> cholesky_;
};

void PairResponse::Push::give(double impulse, Vectors& v) const {
  for (int k = 0; k < 4; ++k) v.row(particles[k]) += impulse * way[k];
}

PairResponse::PairResponse(const SplitOde& ode)
    : ode_(ode),
      allowed_(allowed_directions(ode)),
      constrained_pairs_(ode.work->counter("constrained_pairs", "pairs of the cloth constrained, summed over steps")),
      changes_(ode.work->counter("pair_changes", "changes of the set of constrained pairs")),
      sweeps_(ode.work->counter("pair_sweeps", "sweeps over all pairs that may be constrained")) {
  if (allowed_.empty()) allowed_.assign(ode.particles(), Eigen::Matrix3d::Identity());
  free_ = allowed_;
  u_.setZero(ode.particles(), 3);
}

PairResponse::~PairResponse() = default;

void PairResponse::clear() {
  rows_.clear();
  factor_.reset();
}

PairResponse::Row PairResponse::row_of(const PairContact& pair) const {
  Row row;
  row.pair = pair;
  for (int k = 0; k < 4; ++k) row.direction[k] = pair.begin.weights[k] * (free_[pair.particles[k]] * pair.begin.normal);
  const double missing = ode_.pairs->thickness() - pair.begin.distance;
  row.least = (missing > 0 ? recovery : 1) * missing / h_;
  return row;
}

void PairResponse::begin(double t0, double h, const State& y0, bool again) {
  const base::Stopwatch stopwatch(ode_.response_ms);
  t0_ = t0;
  h_ = h;
  y0_ = &y0;
  found_.clear();
  for (const Row& row : rows_) found_.push_back(row.pair);
  ode_.pairs->renew(y0.x, found_);
  std::vector<Row> before = std::exchange(rows_, {});
  for (std::size_t k = 0; k < found_.size(); ++k) {
    if (found_[k].begin.distance > leaving * ode_.pairs->thickness()) continue;
    Row row = row_of(found_[k]);
    row.active = before[k].active;
    row.before = again ? before[k].before : row.active;
    row.lambda = before[k].lambda;
    rows_.push_back(row);
  }
  u_ = y0.v;
  activate(false);
}

/// Constrains the rows that push, at the velocities of u, and keeps those that were constrained unless they are released.
void PairResponse::activate(bool releases) {
  for (Row& row : rows_) {
    row.active = row.lambda > 0 || (row.active && !releases);
    row.target = row.speed(u_);
  }
  factorise();
}

void PairResponse::factorise() {
  const bool any = std::ranges::any_of(rows_, &Row::active);
  factor_ = any ? std::make_unique<Factor>(rows_, Eigen::VectorXd::Ones(ode_.particles())) : nullptr;
}

void PairResponse::set_free(const Filter& obstacles) {
  if (rows_.empty()) return;
  free_ = allowed_;
  for (const Filter::Block& block : obstacles.blocks()) free_[block.particle] = block.free;
  for (Row& row : rows_) {
    const Row now = row_of(row.pair);
    row.direction = now.direction;
  }
  factorise();
}

bool PairResponse::find(const Stage& stage, const State& y) {
  u_ = y.x + (t0_ + h_ - stage.t) * y.v;
  ode_.pairs->find(y0_->x, u_, worn * ode_.pairs->thickness(), found_);
  const base::Stopwatch stopwatch(ode_.response_ms);
  const auto before = std::ssize(rows_);
  const auto order = [](const Row& row) { return key(row.pair); };
  for (const PairContact& pair : found_) {
    const auto same = std::ranges::lower_bound(rows_.begin(), rows_.begin() + before, key(pair), {}, order);
    if (same == rows_.begin() + before || key(same->pair) != key(pair)) rows_.push_back(row_of(pair));
  }
  if (std::ssize(rows_) == before) return false;
  std::ranges::sort(rows_, {}, order);
  u_ = y.v;
  activate(false);
  return true;
}

/// Moves u, with multipliers, to where all rows and supports keep what is least.
void PairResponse::settle(const Eigen::VectorXd& mass, double noise, std::vector<Support>& supports) {
  loose_ = free_;
  for (const Support& support : supports) loose_[support.particle] += support.normal * support.normal.transpose();
  pushes_.clear();
  for (const Row& row : rows_) {
    Push& push = pushes_.emplace_back(Push{row.pair.particles, row.pair.begin, row.least, row.lambda});
    double unheld = 0;
    for (int k = 0; k < 4; ++k) {
      const double m = mass[push.particles[k]], w = push.points.weights[k];
      push.way[k] = w / m * (loose_[push.particles[k]] * push.points.normal);
      push.gain += w * push.way[k].dot(push.points.normal);
      unheld += w * w / m;
    }
    if (push.gain < held_part * unheld) push.gain = 0;  // pins and obstacles hold the pair
    push.give(row.lambda, u_);
  }
  const double small = settled * noise / std::sqrt(rows_.size());
  double most = small + 1;
  for (int sweep = 0; sweep < most_sweeps && most > small; ++sweep) {
    most = 0;
    ++sweeps_;
    for (Push& push : pushes_) {
      if (push.gain == 0) continue;
      const double impulse = std::max((push.least - push.points.along_normal(push.particles, u_)) / push.gain, -push.lambda);
      if (impulse == 0) continue;
      push.lambda += impulse;
      push.give(impulse, u_);
      most = std::max(most, std::abs(impulse));
    }
    for (Support& support : supports) {
      const double m = mass[support.particle];
      const double impulse = std::max(m * (support.least - u_.row(support.particle).dot(support.normal)), -support.lambda);
      support.lambda += impulse;
      u_.row(support.particle) += impulse / m * support.normal;
      most = std::max(most, std::abs(impulse));
    }
  }
  for (std::size_t r = 0; r < rows_.size(); ++r) rows_[r].lambda = pushes_[r].lambda;
}

bool PairResponse::update(State& y, const Vectors& r, const Eigen::VectorXd& bounds, double noise, bool releases,
                          std::vector<Support>& supports) {
  if (rows_.empty()) return false;
  const base::Stopwatch stopwatch(ode_.response_ms);
  if (!releases) supports.clear();
  std::vector<char> moved(static_cast<std::size_t>(ode_.particles()), false);
  for (const Row& row : rows_)
    for (const int i : row.pair.particles) moved[i] = true;
  std::erase_if(supports, [&](const Support& support) { return !moved[support.particle]; });
  u_ = y.v;
  double force = 0;
  for (int i = 0; i < ode_.particles(); ++i) {
    if (!moved[i]) continue;
    const Eigen::Vector3d pull = free_[i] * r.row(i).transpose();
    u_.row(i) += pull / bounds[i];
    force += pull.squaredNorm();
  }
  noise = std::max(noise, balance * std::sqrt(force));
  settle(bounds, noise, supports);
  const double left = (bounds.asDiagonal() * (u_ - y.v)).norm();
  const bool differs =
      std::ranges::any_of(rows_, [&](const Row& row) { return row.lambda > 0 ? !row.active : releases && row.active; }) ||
      std::ranges::any_of(supports, [](const Support& support) { return support.lambda == 0; });
  if (!differs || left <= 3 * noise) {
    supports.clear();
    return false;
  }
  ++changes_;
  y.v = u_;
  activate(releases);
  return true;
}

void PairResponse::impose(const Stage& stage, State& y) const {
  if (!factor_) return;
  const Vectors before = y.v;
  factor_->add(constrained([](const Row& row) { return row.target; }) - speeds(y.v), y.v);
  y.x += stage.gamma * (y.v - before);  // obstacles have set some directions of x already
  const auto distance = [&](const Row& row) { return row.pair.begin.distance + (stage.t - t0_) * row.target; };
  factor_->add(constrained(distance) - speeds(y.x), y.x);
}

/// A value of each row of the factor.
template <class Value>
Eigen::VectorXd PairResponse::constrained(const Value& value) const {
  const std::vector<int>& rows = factor_->rows();
  Eigen::VectorXd all(std::ssize(rows));
  for (Eigen::Index k = 0; k < all.size(); ++k) all[k] = value(rows_[rows[k]]);
  return all;
}

Eigen::VectorXd PairResponse::speeds(const Vectors& v) const {
  return constrained([&](const Row& row) { return row.speed(v); });
}

void PairResponse::add_forces(Vectors& r) const {
  for (const Row& row : rows_) {
    if (!row.active) continue;
    for (int k = 0; k < 4; ++k) r.row(row.pair.particles[k]) += row.lambda * row.pair.begin.weights[k] * row.pair.begin.normal;
  }
}

void PairResponse::project(Vectors& r) const {
  if (factor_) factor_->add(-factor_->along(r), r);
}

double PairResponse::stopped_energy() const {
  if (!impact()) return 0;
  Vectors stopped = Vectors::Zero(ode_.particles(), 3);
  factor_->add(constrained([&](const Row& row) { return row.before ? 0 : row.speed(y0_->v); }), stopped);
  return kinetic_energy(ode_, stopped);
}

/// At the end pairs have other nearest points, along whose distance impulses keep angular momentum.
void PairResponse::stop(State& y1) {
  found_.clear();
  for (const Row& row : rows_) found_.push_back(row.pair);
  ode_.pairs->renew(y1.x, found_);
  std::vector<Row> at_end;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    if (!rows_[k].active) continue;
    at_end.push_back(row_of(found_[k]));
    at_end.back().active = true;
  }
  const Factor factor(at_end, ode_.mass.cwiseInverse());
  Eigen::VectorXd speed(std::ssize(factor.rows()));
  for (Eigen::Index k = 0; k < speed.size(); ++k) speed[k] = at_end[factor.rows()[k]].speed(y1.v);
  factor.add(-speed, y1.v);
}

bool PairResponse::finish(State& y1, State& y0) {
  if (!factor_) return false;
  constrained_pairs_ += constrained();
  stop(y1);
  if (!impact()) return false;
  const Vectors jump = y1.v - y0.v, way = y1.x - h_ * y1.v - y0.x;
  factor_->add(factor_->along(jump), y0.v);
  factor_->add(factor_->along(way), y0.x);
  return true;
}

bool PairResponse::impact() const {
  return std::ranges::any_of(rows_, [](const Row& row) { return row.active && !row.before; });
}

int PairResponse::constrained() const { return static_cast<int>(std::ranges::count_if(rows_, &Row::active)); }

}  // namespace drape::solver
