#include "model/sheet/strain.hpp"

#include <algorithm>
#include <cmath>

#include "model/sheet/normals.hpp"

namespace drape::model {
namespace {

/// w less its part along N.
Eigen::Vector3d tangential(const Eigen::Vector3d& w, const Eigen::Vector3d& N) { return w - w.dot(N) * N; }

/// The cosine c = <p, q>/(|p| |q|) of the angle between two vectors, with its derivatives.
struct Angle {
  double c, sine;
  Eigen::Vector3d p, q;  ///< of length 1
  double p_length, q_length;
  Eigen::Vector3d by_p, by_q;

  Angle(const Eigen::Vector3d& whole_p, const Eigen::Vector3d& whole_q) : p_length(whole_p.norm()), q_length(whole_q.norm()) {
    p = whole_p / p_length, q = whole_q / q_length;
    c = p.dot(q), sine = p.cross(q).norm();
    by_p = (q - c * p) / p_length, by_q = (p - c * q) / q_length;
  }
};

}  // namespace

Strain Strain::of_edge(const Edge& edge) {
  Strain strain;
  strain.count_ = 2, strain.vectors_ = 1;
  strain.area_ = edge.length * edge.width;
  strain.size_ = edge.length;
  strain.particles_ = {edge.i, edge.j};
  strain.weights_[0] = {-1}, strain.weights_[1] = {1};
  return strain;
}

Strain Strain::of_quadrant(const Metric& metric, const Cell& cell, EdgeEnds p, EdgeEnds q) {
  Strain strain;
  strain.kind_ = Kind::quadrant;
  strain.vectors_ = 2;
  strain.size_ = metric.length(p) * metric.length(q);
  strain.rest_ = metric.product(p, q) / strain.size_;
  strain.area_ = metric.area(cell) / 4;
  const auto add = [&](int particle, int vector, double weight) {
    int j = 0;
    while (j < strain.count_ && strain.particles_[j] != particle) ++j;
    if (j == strain.count_) strain.particles_[strain.count_++] = particle;
    strain.weights_[j][vector] = weight;
  };
  add(p.begin, 0, -1), add(p.end, 0, 1);
  add(q.begin, 1, -1), add(q.end, 1, 1);
  return strain;
}

Strain Strain::of_angle(const Metric& metric, const Cell& cell, EdgeEnds p, EdgeEnds q) {
  Strain strain = of_quadrant(metric, cell, p, q);
  strain.kind_ = Kind::angle;
  return strain;
}

Strain Strain::of_curvature(const Metric& metric, int a, int b, bool weft) {
  Strain strain;
  strain.kind_ = Kind::curvature;
  strain.count_ = 5, strain.vectors_ = 3;
  strain.area_ = metric.bent_area(a, b, weft);
  const LineDifference difference = metric.second_difference(a, b, weft);
  const double per_square = 1 / (difference.length * difference.length);
  // The particle itself, left, right, lower, upper; on a border it is one of the neighbours that span its normal as well.
  const std::array<int, most_particles> entry = weft ? std::array{1, 0, 2, 3, 4} : std::array{1, 3, 4, 0, 2};
  constexpr double along_u[] = {0, -1, 1, 0, 0}, along_v[] = {0, 0, 0, -1, 1};
  for (int j = 0; j < strain.count_; ++j) {
    const auto [particle, coefficient] = difference.entries[entry[j]];
    strain.particles_[j] = particle;
    strain.weights_[j] = {along_u[j], along_v[j], coefficient * per_square};
  }
  return strain;
}

Strain Strain::of_twist(const Metric& metric, const Cell& cell) {
  Strain strain;
  strain.kind_ = Kind::curvature;
  strain.count_ = 4, strain.vectors_ = 3;
  strain.area_ = metric.area(cell);
  const CellDifference difference = metric.mixed_difference(cell);
  const double size = difference.length_u * difference.length_v;
  for (int j = 0; j < strain.count_; ++j) {
    const auto [particle, coefficient] = difference.entries[j];
    strain.particles_[j] = particle;
    strain.weights_[j] = {j >= 2 ? 1.0 : -1.0, j % 2 == 1 ? 1.0 : -1.0, coefficient / size};
  }
  return strain;
}

Strain::Columns Strain::vectors(const Vectors& x) const {
  Columns of;
  for (int k = 0; k < vectors_; ++k) {
    of[k].setZero();
    for (int j = 0; j < count_; ++j)
      if (weights_[j][k] != 0) of[k] += weights_[j][k] * x.row(particles_[j]).transpose();
  }
  return of;
}

double Strain::value(const Columns& of) const {
  switch (kind_) {
    case Kind::edge: return of[0].norm() / size_ - 1;
    case Kind::quadrant: return of[0].dot(of[1]) / size_ - rest_;
    case Kind::angle: return std::asin(of[0].normalized().dot(of[1].normalized()));
    case Kind::curvature: break;
  }
  return of[0].cross(of[1]).normalized().dot(of[2]);
}

/// By each of the vectors. With c = a × b and ε = <w, c>/|c|: ∂ε/∂w = N, ∂ε/∂c = (w − ε N)/|c|.
Strain::Columns Strain::derivatives(const Columns& of) const {
  switch (kind_) {
    case Kind::edge: return {of[0] / (of[0].norm() * size_)};
    case Kind::quadrant: return {of[1] / size_, of[0] / size_};
    case Kind::angle: {
      const Angle angle(of[0], of[1]);
      return {angle.by_p / angle.sine, angle.by_q / angle.sine};
    }
    case Kind::curvature: break;
  }
  const Eigen::Vector3d c = of[0].cross(of[1]), N = c.normalized();
  const Eigen::Vector3d by_c = tangential(of[2], N) / c.norm();
  return {of[1].cross(by_c), by_c.cross(of[0]), N};
}

double Strain::value(const Vectors& x) const { return value(vectors(x)); }

double Strain::value(const Vectors& x, Gradient& by) const {
  const Columns of = vectors(x), slopes = derivatives(of);
  for (int j = 0; j < count_; ++j) {
    by[j].setZero();
    for (int k = 0; k < vectors_; ++k)
      if (weights_[j][k] != 0) by[j] += weights_[j][k] * slopes[k];
  }
  return value(of);
}

double Strain::rate(const Vectors& x, const Vectors& v) const {
  const Columns slopes = derivatives(vectors(x)), rates = vectors(v);
  double rate = 0;
  for (int k = 0; k < vectors_; ++k) rate += slopes[k].dot(rates[k]);
  return rate;
}

void Strain::second_derivatives(const Vectors& x, Hessian& by) const {
  std::array<std::array<Eigen::Matrix3d, most_vectors>, most_vectors> H;
  for (auto& row : H) row.fill(Eigen::Matrix3d::Zero());
  const Columns of = vectors(x);
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  switch (kind_) {
    case Kind::edge: {
      const double r = of[0].norm();
      const Eigen::Vector3d n = of[0] / r;
      H[0][0] = (I - n * n.transpose()) / (r * size_);
      break;
    }
    case Kind::quadrant: H[0][1] = H[1][0] = I / size_; break;
    case Kind::angle: {
      // dε = dc/s and d²ε = d²c/s + c dc dcᵀ/s³, with s the sine.
      const Angle angle(of[0], of[1]);
      const double c = angle.c, s = angle.sine, bent = c / (s * s * s);
      const Eigen::Matrix3d across_p = I - angle.p * angle.p.transpose(), across_q = I - angle.q * angle.q.transpose();
      const auto twice = [&](const Eigen::Vector3d& n, double r, const Eigen::Vector3d& by_n, const Eigen::Matrix3d& across) {
        const Eigen::Matrix3d of_c = -(n * by_n.transpose() + by_n * n.transpose()) / r - c / (r * r) * across;
        return Eigen::Matrix3d(of_c / s + bent * by_n * by_n.transpose());
      };
      H[0][0] = twice(angle.p, angle.p_length, angle.by_p, across_p);
      H[1][1] = twice(angle.q, angle.q_length, angle.by_q, across_q);
      H[0][1] = across_p * across_q / (angle.p_length * angle.q_length * s) + bent * angle.by_p * angle.by_q.transpose();
      H[1][0] = H[0][1].transpose();
      break;
    }
    case Kind::curvature: {
      // ∂²ε/∂c² = −(N w_tᵀ + w_t Nᵀ + ε P)/|c|², ∂²ε/∂w∂c = P/|c|, P = 1 − N Nᵀ, w_t = P w; d²c = 2 da × db.
      const Eigen::Vector3d c = of[0].cross(of[1]), N = c.normalized(), w_t = tangential(of[2], N);
      const double n = c.norm(), value_now = N.dot(of[2]);
      const Eigen::Matrix3d P = I - N * N.transpose();
      const Eigen::Matrix3d cc = -(N * w_t.transpose() + w_t * N.transpose() + value_now * P) / (n * n), wc = P / n;
      const Eigen::Matrix3d by_a = -cross_matrix(of[1]), by_b = cross_matrix(of[0]);  // dc = by_a da + by_b db
      H[0][0] = by_a.transpose() * cc * by_a;
      H[1][1] = by_b.transpose() * cc * by_b;
      H[0][1] = by_a.transpose() * cc * by_b - cross_matrix(w_t / n);
      H[1][0] = H[0][1].transpose();
      H[2][0] = wc * by_a;
      H[2][1] = wc * by_b;
      H[0][2] = H[2][0].transpose();
      H[1][2] = H[2][1].transpose();
      break;
    }
  }
  for (int j = 0; j < count_; ++j)
    for (int k = 0; k < count_; ++k) {
      by[j][k].setZero();
      for (int m = 0; m < vectors_; ++m)
        for (int n = 0; n < vectors_; ++n)
          if (const double weight = weights_[j][m] * weights_[k][n]; weight != 0) by[j][k] += weight * H[m][n];
    }
}

std::vector<LineCurvature> line_curvatures(const Grid& grid) {
  std::vector<LineCurvature> all;
  if (grid.nu < 2 || grid.nv < 2) return all;
  const Metric metric(grid);
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a) {
      for (const bool weft : {true, false})
        if (metric.bends(a, b, weft)) all.push_back({Strain::of_curvature(metric, a, b, weft), weft});
    }
  return all;
}

}  // namespace drape::model
