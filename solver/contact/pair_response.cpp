#include "solver/contact/pair_response.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/base/stopwatch.hpp"

namespace drape::solver {
namespace {

constexpr double recovery = 0.2;      ///< part of what is missing of the thickness that a pair gains in a step
constexpr double worn = 0.95;         ///< part of the thickness below which a pair is missed
constexpr double leaving = 1.5;       ///< thicknesses beyond which a pair of the step before is forgotten
constexpr double turned = 0.95;       ///< cosine of the angle by which its normal may turn before it is
constexpr int most_sweeps = 60;       ///< over all rows
constexpr double balance = 1e-4;      ///< force that may be left where rows push, over that of the residual
constexpr double settled = 0.1;       ///< the same when the sweeps end, over what may be left
constexpr double hard = 0.1;          ///< of the thickness: a pair that comes nearer than this in a step meets with an impact
constexpr double rubbing = 1e-2;      ///< friction that may be missing or too much, over the greatest
constexpr double held_part = 1e-12;   ///< of the part of a row that pins and obstacles leave
constexpr double least_pivot = 1e-6;  ///< sin² of the angle between a row and the span of others that it depends on
constexpr double softening = 1e-8;    ///< over the least pivot, so that none is 0

using Compressed = Eigen::SparseMatrix<double, Eigen::RowMajor>;

auto coordinates(const Vectors& v) { return Eigen::VectorXd::Map(v.data(), v.size()); }
auto coordinates(Vectors& v) { return Eigen::VectorXd::Map(v.data(), v.size()); }

}  // namespace

/// W Cᵀ (C W Cᵀ)⁻¹ with a diagonal W, of the constrained rows without those that depend on others.
class PairResponse::Factor {
 public:
  Factor(const std::vector<Row>& rows, const Eigen::VectorXd& weights) : weights_(thrice(weights)) {
    for (int r = 0; r < std::ssize(rows); ++r)
      for (int c = 0; c < rows[r].constrained(); ++c) rows_.push_back({r, c});
    while (!independent(rows)) {
    }
  }

  /// A direction of one of the rows.
  struct Entry {
    int row, direction;
  };

  const std::vector<Entry>& rows() const { return rows_; }

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
    for (int r = 0; r < std::ssize(rows_); ++r) {
      const Row& row = rows[rows_[r].row];
      for (int k = 0; k < 4; ++k)
        for (int c = 0; c < 3; ++c)
          entries.emplace_back(r, 3 * row.cloth.particles[k] + c, row.left[rows_[r].direction].of[k][c]);
    }
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
    std::vector<Entry> kept;
    for (int r = 0; r < std::ssize(rows_); ++r)
      if (pivots[r] > least_pivot * diagonal[r] && diagonal[r] > least) kept.push_back(rows_[r]);
    return std::ssize(std::exchange(rows_, std::move(kept))) == std::ssize(rows_);
  }

  std::vector<Entry> rows_;
  Compressed C_;
  Eigen::VectorXd weights_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> cholesky_;
};

void PairResponse::Row::add(const Eigen::Vector3d& impulses, Vectors& r) const {
  for (int k = 0; k < 4; ++k)
    for (int c = 0; c < 3; ++c)
      if (impulses[c] != 0) r.row(cloth.particles[k]) += impulses[c] * motion[c].of[k];
}

/// Returns by how much the multiplier changes.
double PairResponse::Push::give(int direction, double impulse, Vectors& v) {
  if (impulse == 0) return 0;
  row->lambda[direction] += impulse;
  for (int k = 0; k < 4; ++k) v.row(row->cloth.particles[k]) += impulse * way[direction][k];
  return std::abs(impulse);
}

double PairResponse::Push::push(Vectors& v) {
  return give(0, std::max((row->least - row->speed(0, v)) / gain[0], -row->lambda[0]), v);
}

double PairResponse::Push::stop_sliding(Vectors& v) {
  const double across = std::max(gain[1], gain[2]);
  if (across == 0) return 0;
  const double first = give(1, -row->slip(1, v) / across, v);
  return std::max(first, give(2, -row->slip(2, v) / across, v));
}

PairResponse::PairResponse(const SplitOde& ode)
    : ode_(ode),
      allowed_(allowed_directions(ode)),
      rubs_(ode.pairs->rubs()),
      constrained_pairs_(ode.work->counter("constrained_pairs", "pairs of the cloth constrained, summed over steps")),
      changes_(ode.work->counter("pair_changes", "changes of the set of constrained pairs")),
      sweeps_(ode.work->counter("pair_sweeps", "sweeps over all pairs that may be constrained")),
      undecided_(ode.work->counter("undecided_pairs", "updates of pairs whose sweeps ended before these had settled")) {
  if (allowed_.empty()) allowed_.assign(ode.particles(), Eigen::Matrix3d::Identity());
  free_ = allowed_;
  pinned_.assign(ode.particles(), false);
  for (const Pin& pin : ode.pins) pinned_[pin.particle] = true;
  u_.setZero(ode.particles(), 3);
}

PairResponse::~PairResponse() = default;

void PairResponse::clear() {
  rows_.clear();
  factor_.reset();
}

PairMotion PairResponse::motion_at(const Row& row, const Vectors& x) const {
  const std::array<int, 4>& particles = row.cloth.particles;
  if (row.cloth.meets_body() || std::ranges::any_of(particles, [&](int i) { return pinned_[i] != 0; }))
    return held_motion_of(row.points, row.cloth.of_body);
  return motion_of(row.points, particles, ode_.mass, x);
}

PairResponse::Row PairResponse::row_of(const PairContact& pair, const PairContact::Points& points) const {
  Row row;
  row.pair = pair;
  row.points = points;
  row.cloth = cloth_part(pair, points, ode_.particles(), ode_.pairs->bodies());
  row.motion = motion_at(row, y0_->x);
  leave(row);
  for (int c = 0; c < 3; ++c) row.start[c] = row.speed(c, y0_->x);
  row.given = axes_of(points.normal).transpose() * row.cloth.way / h_;
  row.target.tail<2>() = -row.given.tail<2>();
  const double missing = pair.keeps - row.start[0] - row.cloth.body.dot(points.normal);
  row.least = (missing > 0 ? recovery : 1) * missing / h_ - row.given[0];
  return row;
}

/// Sets what pins and obstacles leave of a row.
void PairResponse::leave(Row& row) const {
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < 4; ++k) row.left[c].of[k] = free_[row.cloth.particles[k]] * row.motion[c].of[k];
}

void PairResponse::begin(double t0, double h, const State& y0, bool again) {
  const base::Stopwatch stopwatch(ode_.response_ms);
  t0_ = t0;
  h_ = h;
  y0_ = &y0;
  ode_.pairs->begin(t0, h);
  found_.clear();
  for (const Row& row : rows_) found_.push_back(row.pair);
  u_ = y0.x + h * y0.v;
  ode_.pairs->renew(u_, found_);  // where pairs will be: normals where the step begins may be those of borders that they leave
  const std::vector<char> redundant = on_borders(found_, &PairContact::begin);
  std::vector<Row> before = std::exchange(rows_, {});
  for (std::size_t k = 0; k < found_.size(); ++k) {
    const PairContact::Points &now = found_[k].begin, &last = before[k].points;
    if (redundant[k] || now.distance > leaving * found_[k].keeps || now.normal.dot(last.normal) < turned) continue;
    Row row = row_of(found_[k], now);
    row.active = before[k].active;
    row.sticks = before[k].sticks;
    row.before = again ? before[k].before : row.active;
    row.lambda = before[k].lambda;
    row.lambda.tail<2>() =
        axes_of(now.normal).rightCols<2>().transpose() * (axes_of(last.normal).rightCols<2>() * before[k].lambda.tail<2>());
    rows_.push_back(row);
  }
  u_ = y0.v;
  activate(false);
}

/// Constrains the rows that push, at the velocities of u, and keeps those that were constrained unless they are released.
void PairResponse::activate(bool releases) {
  for (Row& row : rows_) {
    row.active = row.lambda[0] > 0 || (row.active && !releases);
    row.target[0] = row.speed(0, u_);
    if (row.active) continue;
    row.sticks = false;
    row.slides.setZero();
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
  for (Row& row : rows_) leave(row);
  factorise();
}

bool PairResponse::find(const Stage& stage, const State& y) {
  u_ = y.x + (t0_ + h_ - stage.t) * y.v;
  ode_.pairs->find(y0_->x, u_, worn, found_);
  const base::Stopwatch stopwatch(ode_.response_ms);
  const auto before = std::ssize(rows_);
  const auto order = [](const Row& row) { return row.pair.order(); };
  for (const PairContact& pair : found_) {
    const auto same = std::ranges::lower_bound(rows_.begin(), rows_.begin() + before, pair.order(), {}, order);
    if (same == rows_.begin() + before || same->pair.order() != pair.order()) rows_.push_back(row_of(pair, pair.touch));
  }
  if (std::ssize(rows_) == before) return false;
  std::ranges::sort(rows_, {}, order);
  u_ = y.v;
  activate(false);
  return true;
}

/// Moves u, with multipliers, to where all rows and supports keep what is least. What sticks keeps sticking, and what slides
/// keeps its friction. False if the sweeps end before that: where many rows push in few directions, multipliers move between
/// them for thousands of sweeps.
bool PairResponse::settle(const Eigen::VectorXd& mass, double noise, std::vector<Support>& supports) {
  loose_ = free_;
  for (const Support& support : supports) loose_[support.particle] += support.normal * support.normal.transpose();
  const int directions = rubs_ ? 3 : 1;
  pushes_.clear();
  for (Row& row : rows_) {
    if (!row.sticks) row.lambda.tail<2>() = row.slides;
    Push& push = pushes_.emplace_back(Push{&row, {}});
    for (int c = 0; c < directions; ++c) {
      double unheld = 0;
      for (int k = 0; k < 4; ++k) {
        const int i = row.cloth.particles[k];
        const Eigen::Vector3d& impulse = row.motion[c].of[k];
        push.way[c][k] = loose_[i] * impulse / mass[i];
        push.gain[c] += push.way[c][k].dot(impulse);
        unheld += impulse.squaredNorm() / mass[i];
        u_.row(i) += row.lambda[c] * push.way[c][k];
      }
      if (push.gain[c] < held_part * unheld) push.gain[c] = 0;  // pins and obstacles hold the pair
    }
  }
  const double small = settled * noise / std::sqrt(rows_.size());
  double most = small + 1;
  for (int sweep = 0; sweep < most_sweeps && most > small; ++sweep) {
    most = 0;
    ++sweeps_;
    for (Push& push : pushes_) {
      if (push.gain[0] == 0) continue;
      most = std::max(most, push.push(u_));
      if (push.row->sticks) most = std::max(most, push.stop_sliding(u_));
    }
    for (Support& support : supports) {
      const double m = mass[support.particle];
      const double impulse = std::max(m * (support.least - u_.row(support.particle).dot(support.normal)), -support.lambda);
      support.lambda += impulse;
      u_.row(support.particle) += impulse / m * support.normal;
      most = std::max(most, std::abs(impulse));
    }
  }
  return most <= small;
}

/// Decides by Coulomb's law how rows rub at velocities v; true if that changes.
bool PairResponse::rub(const Vectors& v, double noise) {
  bool changed = false;
  for (Row& row : rows_) {
    if (!row.active) continue;
    const double most = row.pair.friction * row.lambda[0];
    const Eigen::Vector2d holds = row.lambda.tail<2>(), slip(row.slip(1, v), row.slip(2, v));
    if (row.sticks) {
      if (holds.norm() <= most) continue;
      row.sticks = false;
      row.slides = most * holds.normalized();
    } else if (row.slides.dot(slip) > 0) {  // more than what stops the pair
      row.sticks = true;
      row.slides.setZero();
    } else {
      const Eigen::Vector2d slows = -most * slip.normalized();
      if ((slows - row.slides).norm() <= noise + rubbing * most) continue;
      row.slides = slows;
    }
    changed = true;
  }
  if (changed) factorise();
  return changed;
}

bool PairResponse::update(State& y, const Vectors& r, const Eigen::VectorXd& bounds, double noise, bool releases,
                          std::vector<Support>& supports) {
  if (rows_.empty()) return false;
  const base::Stopwatch stopwatch(ode_.response_ms);
  if (!releases) supports.clear();
  std::vector<char> moved(static_cast<std::size_t>(ode_.particles()), false);
  for (const Row& row : rows_)
    for (const int i : row.cloth.particles) moved[i] = true;
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
  if (!settle(bounds, noise, supports)) ++undecided_;
  const bool changes =
      std::ranges::any_of(rows_, [&](const Row& row) { return row.lambda[0] > 0 ? !row.active : releases && row.active; }) ||
      std::ranges::any_of(supports, [](const Support& support) { return support.lambda == 0; });
  if (changes && (bounds.asDiagonal() * (u_ - y.v)).norm() > 3 * noise) {
    y.v = u_;
    activate(releases);
  } else {
    supports.clear();
    // Friction once the rows that push do not change: before, multipliers may be many times the right ones.
    if (!rubs_ || !releases || !rub(y.v, noise)) return false;
  }
  ++changes_;
  return true;
}

void PairResponse::impose(const Stage& stage, State& y) const {
  if (!factor_) return;
  const Vectors before = y.v;
  factor_->add(constrained([](const Row& row, int c) { return row.target[c]; }) - speeds(y.v), y.v);
  y.x += stage.gamma * (y.v - before);  // obstacles have set some directions of x already
  const auto there = [&](const Row& row, int c) { return row.start[c] + (stage.t - t0_) * row.target[c]; };
  factor_->add(constrained(there) - speeds(y.x), y.x);
}

/// A value of each direction of the factor.
template <class Value>
Eigen::VectorXd PairResponse::constrained(const Value& value) const {
  Eigen::VectorXd all(std::ssize(factor_->rows()));
  Eigen::Index k = 0;
  for (const auto [row, direction] : factor_->rows()) all[k++] = value(rows_[row], direction);
  return all;
}

Eigen::VectorXd PairResponse::speeds(const Vectors& v) const {
  return constrained([&](const Row& row, int c) { return row.speed(c, v); });
}

void PairResponse::add_forces(Vectors& r) const {
  for (const Row& row : rows_)
    if (row.active) row.add(row.sticks ? row.lambda : Eigen::Vector3d(row.lambda[0], row.slides[0], row.slides[1]), r);
}

void PairResponse::add_friction(Vectors& r) const {
  if (!rubs_) return;
  for (const Row& row : rows_) row.add({0, row.slides[0], row.slides[1]}, r);
}

void PairResponse::project(Vectors& r) const {
  if (factor_) factor_->add(-factor_->along(r), r);
}

double PairResponse::stopped_energy() const {
  if (!impact()) return 0;
  Vectors stopped = Vectors::Zero(ode_.particles(), 3);
  factor_->add(constrained([&](const Row& row, int c) { return row.before ? 0 : row.slip(c, y0_->v); }), stopped);
  return kinetic_energy(ode_, stopped);
}

/// Impulses at the end keep angular momentum if they have no torque there.
void PairResponse::stop(State& y1) {
  std::vector<Row> at_end;
  for (const Row& row : rows_) {
    if (!row.active) continue;
    at_end.push_back(row);
    at_end.back().motion = motion_at(row, y1.x);
    leave(at_end.back());
  }
  const Factor factor(at_end, ode_.mass.cwiseInverse());
  Eigen::VectorXd speed(std::ssize(factor.rows()));
  Eigen::Index k = 0;
  for (const auto [row, direction] : factor.rows()) speed[k++] = at_end[row].slip(direction, y1.v);
  factor.add(-speed, y1.v);
}

bool PairResponse::finish(State& y1, State& y0) {
  if (!factor_) return false;
  constrained_pairs_ += constrained();
  stop(y1);
  if (!impact()) return false;
  // The friction of an impact has an impulse too.
  std::vector<Row> impulsive = rows_;
  for (Row& row : impulsive)
    row.sticks = row.sticks || (row.pair.friction > 0 && !row.before && -h_ * row.slip(0, y0.v) > hard * row.pair.keeps);
  const Factor factor(impulsive, Eigen::VectorXd::Ones(ode_.particles()));
  const Vectors jump = y1.v - y0.v, way = y1.x - h_ * y1.v - y0.x;
  factor.add(factor.along(jump), y0.v);
  factor.add(factor.along(way), y0.x);
  return true;
}

bool PairResponse::impact() const {
  return std::ranges::any_of(rows_, [](const Row& row) { return row.active && !row.before; });
}

int PairResponse::constrained() const { return static_cast<int>(std::ranges::count_if(rows_, &Row::active)); }

}  // namespace drape::solver
