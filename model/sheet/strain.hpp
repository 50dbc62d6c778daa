#pragma once

#include <array>
#include <vector>

#include "model/sheet/metric.hpp"

namespace drape::model {

/// A scalar strain ε of a few particles, with its derivatives. It is a function of up to three vectors a, b, w, each a sum of
/// positions with constant weights.
class Strain {
 public:
  static constexpr int most_particles = 5;

  /// |p|/l − 1 of an edge.
  static Strain of_edge(const Edge& edge);

  /// <s_u, s_v> of a quadrant, less than at rest; the edges p and q of a cell share a corner.
  static Strain of_quadrant(const Metric& metric, const Cell& cell, EdgeEnds p, EdgeEnds q);

  /// The angle between the edges p and q of a cell less than a right one, asin <p, q>/(|p| |q|).
  static Strain of_angle(const Metric& metric, const Cell& cell, EdgeEnds p, EdgeEnds q);

  /// The normal curvature <N, s_uu> or <N, s_vv> of particle (a, b), which is not on the ends of the line [1/m].
  static Strain of_curvature(const Metric& metric, int a, int b, bool weft);

  /// The twist <N, s_uv> of a cell [1/m].
  static Strain of_twist(const Metric& metric, const Cell& cell);

  double area() const { return area_; }  ///< that it stands for [m²]

  /// Whether it is that of an edge; its ends and rest length [m].
  bool couples_edge() const { return kind_ == Kind::edge; }
  EdgeEnds edge() const { return {particles_[0], particles_[1]}; }
  double length() const { return size_; }

  int count() const { return count_; }
  int particle(int j) const { return particles_[j]; }

  double value(const Vectors& x) const;
  double rate(const Vectors& x, const Vectors& v) const;

  /// The value, and ∂ε/∂x_j for all particles.
  using Gradient = std::array<Eigen::Vector3d, most_particles>;
  double value(const Vectors& x, Gradient& by) const;

  /// All blocks ∂²ε/∂x_j∂x_k.
  using Hessian = std::array<std::array<Eigen::Matrix3d, most_particles>, most_particles>;
  void second_derivatives(const Vectors& x, Hessian& by) const;

  /// Adds the force −A σ ∂ε/∂x of a stress σ, and the blocks of its Jacobian, −A (dσ/dε ∂ε/∂x ∂ε/∂xᵀ + σ ∂²ε/∂x²). `by`: the
  /// gradient.
  void add_force(double stress, const Gradient& by, Vectors& f) const {
    const double pull = area_ * stress;
    for (int j = 0; j < count_; ++j) f.row(particles_[j]) -= pull * by[j];
  }
  template <class Add>
  void add_jacobian(const Vectors& x, double stress, double slope, const Gradient& by, const Add& add) const {
    Hessian second;
    if (stress != 0) second_derivatives(x, second);
    for (int j = 0; j < count_; ++j)
      for (int k = 0; k < count_; ++k) {
        Eigen::Matrix3d block = -area_ * slope * by[j] * by[k].transpose();
        if (stress != 0) block -= area_ * stress * second[j][k];
        add(particles_[j], particles_[k], block);
      }
  }

 private:
  enum class Kind { edge, quadrant, angle, curvature };
  static constexpr int most_vectors = 3;
  using Columns = std::array<Eigen::Vector3d, most_vectors>;

  Columns vectors(const Vectors& x) const;
  double value(const Columns& of) const;
  Columns derivatives(const Columns& of) const;

  Kind kind_ = Kind::edge;
  int count_ = 0, vectors_ = 0;
  double area_ = 0;
  double size_ = 1;  ///< length of an edge; product of the lengths of a quadrant's edges
  double rest_ = 0;  ///< <s_u, s_v> of a quadrant at rest
  std::array<int, most_particles> particles_{};
  std::array<std::array<double, most_vectors>, most_particles> weights_{};
};

/// A curvature along weft or warp.
struct LineCurvature {
  Strain strain;
  bool weft;
};

/// Those of all particles that have one, particle by particle; none on a chain, which has no normals.
std::vector<LineCurvature> line_curvatures(const Grid& grid);

}  // namespace drape::model
