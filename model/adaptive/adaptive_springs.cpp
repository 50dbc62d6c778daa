#include "model/adaptive/adaptive_springs.hpp"

#include <algorithm>
#include <utility>

#include "model/forces/spring_blocks.hpp"

namespace drape::model {
namespace {

/// Part of a spring below which a rest length counts as none: forces over it would have no digits.
constexpr double shortest_part = 1e-9;

}  // namespace

AdaptiveSprings::AdaptiveSprings(const Sheet& sheet, std::span<const std::array<int, 3>> faces, const Vectors& places,
                                 BodySurface obstacles, const solver::SplitOde& ode)
    : obstacles_(std::move(obstacles)),
      search_(faces, places, obstacles_.mesh(), *ode.work),
      neighbours_(search_.sheet(), edges(sheet.grid)),
      k_(sheet.material.tension),
      d_(sheet.material.damping),
      projected_(sheet.material.damping_form == DampingForm::projected),
      edges_(edges(sheet.grid)),
      whole_stiffness_(ode.stiffness),
      whole_damping_(ode.damping),
      stiffness_(ode.stiffness),
      damping_(ode.damping),
      searches_(ode.work->counter("adaptive_searches", "steps for which virtual particles were computed")),
      divided_springs_(ode.work->counter("divided_springs", "springs that obstacles divide, summed over these steps")) {
  for (const Edge& edge : edges_) springs_.push_back({{edge.i, edge.j}, strand(edge, edge.length)});
}

AdaptiveSprings::Strand AdaptiveSprings::strand(const Edge& edge, double length) const {
  return {along(k_, edge) * edge.width, along(d_, edge) * edge.width, length};
}

void AdaptiveSprings::begin(double t, const solver::State& y) {
  if (x_.rows() > 0 && t == t_ && x_ == y.x) return;
  t_ = t;
  x_ = y.x;
  obstacles_.place(t, positions_, velocities_);
  ++searches_;
  const std::vector<DividedSpring> found = neighbours_.find(x_, search_.find(x_, positions_));
  divided_springs_ += std::ssize(found);
  if (found.empty() && divided_.empty()) return;
  for (const int s : divided_) springs_[s].first = -1;
  divided_.clear();
  ends_.clear();
  for (const DividedSpring& spring : found) divide(spring);
  set_matrices();
  ++changes_;
}

void AdaptiveSprings::divide(const DividedSpring& divided) {
  const Edge& edge = edges_[divided.spring];
  springs_[divided.spring].first = static_cast<int>(ends_.size());
  divided_.push_back(divided.spring);
  const auto add_end = [&](int node, const VirtualNeighbour& to) {
    const VirtualParticle& particle = to.particle;
    Eigen::Vector3d moves = Eigen::Vector3d::Zero();
    if (!velocities_.empty()) {
      const auto [from, end] = search_.obstacle().edges()[particle.edge].ends;
      moves = (1 - particle.parameter) * velocities_[from] + particle.parameter * velocities_[end];
    }
    ends_.push_back({node, strand(edge, to.length < shortest_part * edge.length ? 0 : to.length), particle.position, moves});
  };
  add_end(edge.i, divided.of_i);
  add_end(edge.j, divided.of_j);
}

void AdaptiveSprings::set_matrices() {
  stiffness_ = whole_stiffness_;
  damping_ = whole_damping_;
  const auto replace = [&](SparseMatrix& matrix, const Spring& spring, double Strand::*modulus) {
    const double whole = spring.strand.*modulus / spring.strand.length;
    if (whole == 0) return;
    const auto [i, j] = spring.ends;
    matrix.coeffRef(i, j) -= whole;
    matrix.coeffRef(j, i) -= whole;
    for (const int first : {spring.first, spring.first + 1}) {
      const auto& [node, part, at, moves] = ends_[first];
      matrix.coeffRef(node, node) += whole - (part.length > 0 ? part.*modulus / part.length : 0);
    }
  };
  for (const int s : divided_) {
    replace(stiffness_, springs_[s], &Strand::k);
    if (!projected_) replace(damping_, springs_[s], &Strand::d);
  }
}

/// The pull of a strand along d whose ends part with the velocity u.
Eigen::Vector3d AdaptiveSprings::pull(const Strand& strand, Part part, const Eigen::Vector3d& d,
                                      const Eigen::Vector3d& u) const {
  const bool whole = part == Part::whole;
  const Eigen::Vector3d n = d.normalized();
  Eigen::Vector3d sum = whole ? Eigen::Vector3d(strand.k / strand.length * d - strand.k * n) : Eigen::Vector3d(-strand.k * n);
  if (projected_) sum += strand.d / strand.length * u.dot(n) * n;
  if (!projected_ && whole) sum += strand.d / strand.length * u;
  return sum;
}

Eigen::Vector3d AdaptiveSprings::pull(const End& end, Part part, double t, const Vectors& x, const Vectors& v) const {
  const Strand& strand = end.strand;
  if (strand.length == 0) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d at = end.place(t - t_);
  Eigen::Vector3d sum = pull(strand, part, at - x.row(end.node).transpose(), end.moves - v.row(end.node).transpose());
  if (part == Part::without_linear) {
    sum += strand.k / strand.length * at;
    if (!projected_) sum += strand.d / strand.length * end.moves;
  }
  return sum;
}

void AdaptiveSprings::add(Part part, double t, const Vectors& x, const Vectors& v, Vectors& f) const {
  for (const int s : divided_) {
    const auto& [ends, strand, first] = springs_[s];
    const auto [i, j] = ends;
    add_pull(f, ends, -pull(strand, part, x.row(j) - x.row(i), v.row(j) - v.row(i)));
    f.row(i) += pull(ends_[first], part, t, x, v);
    f.row(j) += pull(ends_[first + 1], part, t, x, v);
  }
}

void AdaptiveSprings::of_obstacles(Part part, double t, const solver::State& y, Vectors& f) const {
  f.setZero(y.x.rows(), 3);
  for (const End& end : ends_) f.row(end.node) += pull(end, part, t, y.x, y.v);
}

/// Without parts between virtual particles, on which no equation depends.
double AdaptiveSprings::energy(double t, const Vectors& x) const {
  const auto of = [](const Strand& strand, const Eigen::Vector3d& d) {
    const double elongation = d.norm() - strand.length;
    return strand.length == 0 ? 0 : strand.k / strand.length * elongation * elongation / 2;
  };
  double sum = 0;
  for (const int s : divided_) {
    const auto& [ends, strand, first] = springs_[s];
    const auto [i, j] = ends;
    sum -= of(strand, x.row(j) - x.row(i));
    for (const End& end : {ends_[first], ends_[first + 1]})
      sum += of(end.strand, end.place(t - t_) - x.row(end.node).transpose());
  }
  return sum;
}

void AdaptiveSprings::visit(double t, const Vectors& x, const Vectors& v, const JacobianEntries& entries) const {
  using Eigen::Matrix3d, Eigen::Vector3d;
  const bool damped = d_.any(), turns = damped && projected_ && entries.exact();
  const auto dx_of = [&](const Strand& strand, const Vector3d& d, const Vector3d& u) {
    Matrix3d block = strand.k * tension_block(d, strand.length, entries.exact());
    if (turns) block += strand.d * viscous_turn_block(d, u, strand.length);
    return block;
  };
  const auto dv_of = [&](const Strand& strand, const Vector3d& d) -> Matrix3d {
    return strand.d * (projected_ ? viscous_block(d, strand.length) : Matrix3d(Matrix3d::Identity() / strand.length));
  };
  for (const auto& [ends, strand, first] : springs_) {
    const auto [i, j] = ends;
    Matrix3d dx = Matrix3d::Zero(), dv = Matrix3d::Zero();
    std::array<Matrix3d, 2> end_dx{dx, dx}, end_dv{dv, dv};
    if (first >= 0) {
      const Vector3d d = x.row(j) - x.row(i);
      dx = -dx_of(strand, d, v.row(j) - v.row(i));
      if (damped) dv = -dv_of(strand, d);
      for (int k = 0; k < 2; ++k) {
        const End& end = ends_[first + k];
        if (end.strand.length == 0) continue;
        const Vector3d to = end.place(t - t_) - x.row(end.node).transpose();
        end_dx[k] = -dx_of(end.strand, to, end.moves - v.row(end.node).transpose());
        if (damped) end_dv[k] = -dv_of(end.strand, to);
      }
    }
    const auto add_all = [&, from = i, to = j](const JacobianEntries::Add& add, const Matrix3d& whole, const auto& of_ends) {
      add(from, from, of_ends[0] - whole);
      add(from, to, whole);
      add(to, from, whole);
      add(to, to, of_ends[1] - whole);
    };
    add_all(entries.add_dx, dx, end_dx);
    if (damped) add_all(entries.add_dv, dv, end_dv);
  }
}

}  // namespace drape::model
