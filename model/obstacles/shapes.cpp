#include "model/obstacles/shapes.hpp"

#include <cmath>
#include <limits>

namespace drape::model {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// p/|p|, or `otherwise` where p has no direction.
template <class Vector>
Vector direction(const Vector& p, const Vector& otherwise) {
  const double norm = p.stableNorm();
  return norm < std::numeric_limits<double>::min() ? otherwise : Vector(p / norm);
}

/// The distance to a convex corner and the normal there: `q` is the signed distance to each of its orthogonal sides.
template <class Vector>
std::pair<double, Vector> nearest_of_corner(const Vector& q) {
  Eigen::Index side = 0;
  const double inside = q.maxCoeff(&side);
  if (inside <= 0) return {inside, Vector::Unit(side)};
  const Vector beyond = q.cwiseMax(0);
  return {beyond.stableNorm(), beyond.stableNormalized()};
}

class HalfSpace : public Shape {
 public:
  Nearest nearest(const Vector3d& p) const override { return {p.z(), Vector3d::UnitZ()}; }
};

class Sphere : public Shape {
 public:
  explicit Sphere(double radius) : radius_(radius) {}
  Nearest nearest(const Vector3d& p) const override { return {p.norm() - radius_, direction<Vector3d>(p, Vector3d::UnitZ())}; }

 private:
  double radius_;
};

class Box : public Shape {
 public:
  explicit Box(const Vector3d& size) : half_(size / 2) {}
  Nearest nearest(const Vector3d& p) const override {
    auto [distance, normal] = nearest_of_corner<Vector3d>(p.cwiseAbs() - half_);
    for (int c = 0; c < 3; ++c) normal[c] = std::copysign(normal[c], p[c]);
    return {distance, normal};
  }

 private:
  Vector3d half_;
};

class Cylinder : public Shape {
 public:
  Cylinder(double radius, double height) : radius_(radius), half_height_(height / 2) {}
  Nearest nearest(const Vector3d& p) const override {
    const Vector2d across = p.head<2>();
    const auto [distance, n] = nearest_of_corner<Vector2d>({across.norm() - radius_, std::abs(p.z()) - half_height_});
    const Vector2d radial = n[0] * direction<Vector2d>(across, Vector2d::UnitX());
    return {distance, {radial.x(), radial.y(), std::copysign(n[1], p.z())}};
  }

 private:
  double radius_, half_height_;
};

}  // namespace

std::unique_ptr<const Shape> half_space() { return std::make_unique<HalfSpace>(); }
std::unique_ptr<const Shape> sphere(double radius) { return std::make_unique<Sphere>(radius); }
std::unique_ptr<const Shape> box(const Vector3d& size) { return std::make_unique<Box>(size); }
std::unique_ptr<const Shape> cylinder(double radius, double height) { return std::make_unique<Cylinder>(radius, height); }

}  // namespace drape::model
