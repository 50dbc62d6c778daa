#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "model/obstacles/shapes/exact_shape.hpp"
#include "model/obstacles/shapes/shape_kinds.hpp"

namespace drape::model {
namespace {

using Eigen::Vector3d;

/// The hull of two spheres: a cone between round ends.
class RoundCone : public Shape {
 public:
  RoundCone(const Vector3d& from, double r_from, const Vector3d& to, double r_to)
      : from_(from),
        axis_((to - from).normalized()),
        length_((to - from).norm()),
        r_from_(r_from),
        r_to_(r_to),
        slant_((r_from - r_to) / length_) {}

  /// Exact, with its gradient. A tangent of both circles in a plane through the axis has the normal (cos, slant).
  Nearest nearest(const Vector3d& p) const override {
    const Vector3d q = p - from_;
    const double along = q.dot(axis_);
    const Vector3d across = q - along * axis_;
    const double r = across.norm(), cosine = std::sqrt(1 - slant_ * slant_), place = cosine * along - slant_ * r;
    if (place <= 0) return of_sphere(q, r_from_);
    if (place >= cosine * length_) return of_sphere(q - length_ * axis_, r_to_);
    const Vector3d radial = direction<Vector3d>(across, axis_.unitOrthogonal());
    return {cosine * r + slant_ * along - r_from_, cosine * radial + slant_ * axis_};
  }

  void add_surface(Polygons& all) const {
    constexpr int rings = 4;  // on each end
    const double tilt = std::asin(slant_);
    std::vector<ProfilePoint> profile;
    for (int k = 0; k <= rings; ++k) {
      const double angle = -std::numbers::pi / 2 + (tilt + std::numbers::pi / 2) * (k + 0.5) / (rings + 0.5);
      profile.push_back({r_from_ * std::cos(angle), r_from_ * std::sin(angle)});
    }
    for (int k = 0; k <= rings; ++k) {
      const double angle = tilt + (std::numbers::pi / 2 - tilt) * k / (rings + 0.5);
      profile.push_back({r_to_ * std::cos(angle), length_ + r_to_ * std::sin(angle)});
    }
    const Polygons own = turned(profile);
    const auto turn = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), axis_);
    const int first = static_cast<int>(all.vertices.size());
    for (const Vector3d& vertex : own.vertices) all.vertices.emplace_back(from_ + turn * vertex);
    for (std::vector<int> face : own.faces) {
      for (int& corner : face) corner += first;
      all.faces.push_back(std::move(face));
    }
  }

 private:
  static Nearest of_sphere(const Vector3d& q, double radius) {
    return {q.norm() - radius, direction<Vector3d>(q, Vector3d::UnitZ())};
  }

  Vector3d from_, axis_;
  double length_, r_from_, r_to_;
  double slant_;  ///< sine of the angle of the cone
};

/// A figure for a height of 1.7 m, its soles at z = 0, that looks along −y.
struct Mannequin : ShapeRule {
  static constexpr double drawn = 1.7;  ///< [m]

  double height = drawn;  ///< [m]
  double arms = 25;       ///< angle with the vertical [degrees]

  std::vector<RoundCone> cones() const {
    std::vector<RoundCone> all;
    const double scale = height / drawn, angle = arms * std::numbers::pi / 180;
    const auto add = [&](const Vector3d& from, double r_from, const Vector3d& to, double r_to) {
      all.emplace_back(scale * from, scale * r_from, scale * to, scale * r_to);
    };
    add({0, -0.02, 1.55}, 0.065, {0, -0.015, 1.615}, 0.085);       // head
    add({0, 0.01, 1.40}, 0.058, {0, 0, 1.51}, 0.05);               // neck
    add({-0.15, 0.01, 1.385}, 0.052, {0.15, 0.01, 1.385}, 0.052);  // shoulders
    add({-0.07, 0, 1.28}, 0.105, {0.07, 0, 1.28}, 0.105);          // chest
    add({0, 0, 1.06}, 0.1, {0, 0, 1.3}, 0.11);                     // trunk
    add({-0.045, 0, 1.08}, 0.09, {0.045, 0, 1.08}, 0.09);          // waist
    add({-0.08, 0.005, 0.93}, 0.1, {0.08, 0.005, 0.93}, 0.1);      // hips
    for (const double side : {-1.0, 1.0}) {
      const Vector3d shoulder(side * 0.165, 0.01, 1.39), down(side * std::sin(angle), 0, -std::cos(angle));
      const Vector3d elbow = shoulder + 0.29 * down, wrist = elbow + 0.25 * down;
      const Vector3d knee(side * 0.095, -0.005, 0.48), ankle(side * 0.1, 0.01, 0.08);
      add(shoulder, 0.047, elbow, 0.038);
      add(elbow, 0.038, wrist, 0.027);
      add(wrist, 0.028, wrist + 0.13 * down, 0.022);  // hand
      add({side * 0.09, 0, 0.9}, 0.085, knee, 0.052);
      add(knee, 0.052, ankle, 0.038);
      add({side * 0.1, 0.025, 0.04}, 0.04, {side * 0.12, -0.13, 0.03}, 0.03);  // foot
    }
    return all;
  }

  std::unique_ptr<const Shape> make() const override;
  std::vector<std::unique_ptr<const Shape>> parts() const override;

  Polygons surface(double /*plane_side*/) const override {
    Polygons all;
    for (const RoundCone& cone : cones()) cone.add_surface(all);
    return all;
  }
};

/// Exact outside.
class Union : public Shape {
 public:
  explicit Union(std::vector<RoundCone> parts) : parts_(std::move(parts)) {}

  Nearest nearest(const Vector3d& p) const override {
    Nearest least = parts_.front().nearest(p);
    for (const RoundCone& part : parts_)
      if (const Nearest other = part.nearest(p); other.distance < least.distance) least = other;
    return least;
  }

 private:
  std::vector<RoundCone> parts_;
};

std::unique_ptr<const Shape> Mannequin::make() const { return std::make_unique<Union>(cones()); }

std::vector<std::unique_ptr<const Shape>> Mannequin::parts() const {
  std::vector<std::unique_ptr<const Shape>> all;
  for (const RoundCone& cone : cones()) all.push_back(std::make_unique<RoundCone>(cone));
  return all;
}

void read_arms(const Value& value, ShapeRule& rule) {
  const double arms = value.non_negative();
  if (arms > 90) value.fail("an angle with the vertical of at most 90 degrees");
  at<&Mannequin::arms>.in(rule) = arms;
}

constexpr Key<ShapeRule> mannequin_keys[] = {
    {"height", "m", "from its soles, at z = 0, to the top of its head", at<&Mannequin::height>, check::positive},
    {"arms", "degrees", "angle of its arms with the vertical", read_arms,
     [](const ShapeRule& rule) -> Data { return at<&Mannequin::arms>.in(rule); }},
};

}  // namespace

const ShapeKind shapes::mannequin{.name = "mannequin",
                                  .description = "a standing figure of 1.7 m, made of round cones",
                                  .smooth = true,
                                  .create = create<Mannequin>,
                                  .keys = keys_in<mannequin_keys>};

}  // namespace drape::model
