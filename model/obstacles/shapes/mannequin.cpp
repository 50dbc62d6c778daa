#include <Eigen/Geometry>
#include <algorithm>
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

/// Which limb a part belongs to.
enum class Limb { trunk, upper_arm, forearm, thigh, shank };

/// A round cone of the standing figure with the limb that carries it: its side is −1 or 1, 0 of the trunk.
struct BodyPart {
  RoundCone cone;
  Limb limb;
  double side;
};

/// A turn about the axis x through a joint. Positive angles swing what hangs down forwards, to −y.
Pose swing(const Vector3d& joint, double degrees) {
  const Eigen::Quaterniond rotation(Eigen::AngleAxisd(-degrees * std::numbers::pi / 180, Vector3d::UnitX()));
  return {joint - rotation * joint, rotation};
}

/// A figure for a height of 1.7 m, its soles at z = 0, that looks along −y and walks there.
struct Mannequin : ShapeRule {
  static constexpr double drawn = 1.7;  ///< [m]

  double height = drawn;  ///< [m]
  double arms = 25;       ///< angle with the vertical [degrees]
  double legs = 0;        ///< the same [degrees]
  double speed = 0;       ///< of walking [m/s]; 0: it stands
  double walks_from = 0;  ///< the time at which it begins to walk [s]

  std::vector<BodyPart> body() const {
    std::vector<BodyPart> all;
    const auto add = [&](Limb limb, double side, const Vector3d& from, double r_from, const Vector3d& to, double r_to) {
      all.push_back({RoundCone(scale() * from, scale() * r_from, scale() * to, scale() * r_to), limb, side});
    };
    const auto trunk = [&](const Vector3d& from, double r_from, const Vector3d& to, double r_to) {
      add(Limb::trunk, 0, from, r_from, to, r_to);
    };
    trunk({0, -0.02, 1.55}, 0.065, {0, -0.015, 1.615}, 0.085);       // head
    trunk({0, 0.01, 1.40}, 0.058, {0, 0, 1.51}, 0.05);               // neck
    trunk({-0.15, 0.01, 1.385}, 0.052, {0.15, 0.01, 1.385}, 0.052);  // shoulders
    trunk({-0.07, 0, 1.28}, 0.105, {0.07, 0, 1.28}, 0.105);          // chest
    trunk({0, 0, 1.06}, 0.1, {0, 0, 1.3}, 0.11);                     // trunk
    trunk({-0.045, 0, 1.08}, 0.09, {0.045, 0, 1.08}, 0.09);          // waist
    trunk({-0.08, 0.005, 0.93}, 0.1, {0.08, 0.005, 0.93}, 0.1);      // hips
    for (const double side : {-1.0, 1.0}) {
      const Vector3d knee = knee_of(side), ankle = of_leg(side, {0.1, 0.01, 0.08}), elbow = elbow_of(side);
      const Vector3d wrist = elbow + 0.25 * down(side);
      add(Limb::upper_arm, side, shoulder_of(side), 0.047, elbow, 0.038);
      add(Limb::forearm, side, elbow, 0.038, wrist, 0.027);
      add(Limb::forearm, side, wrist, 0.028, wrist + 0.13 * down(side), 0.022);  // hand
      add(Limb::thigh, side, hip_of(side), 0.085, knee, 0.052);
      add(Limb::shank, side, knee, 0.052, ankle, 0.038);
      add(Limb::shank, side, of_leg(side, {0.1, 0.025, 0.04}), 0.04, of_leg(side, {0.12, -0.13, 0.03}), 0.03);  // foot
    }
    return all;
  }

  std::unique_ptr<const Shape> make() const override;
  std::vector<std::unique_ptr<const Shape>> parts() const override;

  Polygons surface(double /*plane_side*/) const override {
    Polygons all;
    for (const BodyPart& part : body()) part.cone.add_surface(all);
    return all;
  }

  bool moves() const override { return speed > 0; }

  Polygons surface_of_part(std::size_t part, double /*plane_side*/) const override {
    Polygons own;
    body()[part].cone.add_surface(own);
    return own;
  }

  /// Walking with sinusoidal hips, shoulders and knees. A cycle is two steps and as long as 0.8 of the height; hips swing by
  /// 22 degrees about 6 forwards, knees bend by 2 to 46 while their leg swings forwards, arms swing by 18 against the legs, and
  /// the trunk is lowest, by 0.016 of the height, when the legs are farthest apart. It gets under way within a second.
  Pose pose_of_part(std::size_t part, double t) const override {
    const BodyPart limb = body()[part];
    const double under_way = std::clamp(t - walks_from, 0.0, 1.0), share = under_way * under_way * (3 - 2 * under_way);
    const double way = speed * (t - walks_from > 1 ? t - walks_from - 0.5 : way_to_speed(under_way));
    const double phase = 2 * std::numbers::pi * way / (0.8 * height) + (limb.side > 0 ? std::numbers::pi : 0);
    Pose whole{{0, -way, -0.008 * height * share * (1 - std::cos(2 * phase))}};
    const double hip = share * (6 + 22 * std::sin(phase)), knee = share * (24 + 22 * std::cos(phase - 0.35));
    const double shoulder = -share * 18 * std::sin(phase), elbow = share * 12;
    switch (limb.limb) {
      case Limb::trunk: return whole;
      case Limb::upper_arm: return whole * swing(scale() * shoulder_of(limb.side), shoulder);
      case Limb::forearm:
        return whole * swing(scale() * shoulder_of(limb.side), shoulder) * swing(scale() * elbow_of(limb.side), elbow);
      case Limb::thigh: return whole * swing(scale() * hip_of(limb.side), hip);
      case Limb::shank: return whole * swing(scale() * hip_of(limb.side), hip) * swing(scale() * knee_of(limb.side), -knee);
    }
    return whole;
  }

 private:
  double scale() const { return height / drawn; }

  // Places in a figure of 1.7 m.
  Vector3d down(double side) const {
    const double angle = arms * std::numbers::pi / 180;
    return {side * std::sin(angle), 0, -std::cos(angle)};
  }
  Vector3d shoulder_of(double side) const { return {side * 0.165, 0.01, 1.39}; }
  Vector3d elbow_of(double side) const { return shoulder_of(side) + 0.29 * down(side); }
  Vector3d hip_of(double side) const { return {side * 0.09, 0, 0.9}; }
  Vector3d knee_of(double side) const { return of_leg(side, {0.095, -0.005, 0.48}); }

  /// Where a point of the left leg of a figure with parallel legs is, or its mirror image.
  Vector3d of_leg(double side, const Vector3d& p) const {
    if (legs == 0) return {side * p.x(), p.y(), p.z()};
    const Vector3d hip = hip_of(1), way = Eigen::AngleAxisd(-legs * std::numbers::pi / 180, Vector3d::UnitY()) * (p - hip);
    return {side * (hip + way).x(), (hip + way).y(), (hip + way).z()};
  }

  /// The integral of the share of its speed, from the beginning on [s].
  static double way_to_speed(double s) { return s * s * s - s * s * s * s / 2; }
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

std::unique_ptr<const Shape> Mannequin::make() const {
  std::vector<RoundCone> cones;
  for (const BodyPart& part : body()) cones.push_back(part.cone);
  return std::make_unique<Union>(std::move(cones));
}

std::vector<std::unique_ptr<const Shape>> Mannequin::parts() const {
  std::vector<std::unique_ptr<const Shape>> all;
  for (const BodyPart& part : body()) all.push_back(std::make_unique<RoundCone>(part.cone));
  return all;
}

void read_arms(const Value& value, ShapeRule& rule) {
  const double arms = value.non_negative();
  if (arms > 90) value.fail("an angle with the vertical of at most 90 degrees");
  at<&Mannequin::arms>.in(rule) = arms;
}

void read_legs(const Value& value, ShapeRule& rule) {
  const double legs = value.non_negative();
  if (legs > 30) value.fail("an angle of at most 30 degrees");
  at<&Mannequin::legs>.in(rule) = legs;
}

constexpr Key<ShapeRule> mannequin_keys[] = {
    {"height", "m", "from its soles, at z = 0, to the top of its head", at<&Mannequin::height>, check::positive},
    {"arms", "degrees", "angle of its arms with the vertical", read_arms,
     [](const ShapeRule& rule) -> Data { return at<&Mannequin::arms>.in(rule); }},
    {"legs", "degrees", "angle by which each of its legs is spread", read_legs,
     [](const ShapeRule& rule) -> Data { return at<&Mannequin::legs>.in(rule); }},
    {"walk", "m/s", "speed at which it walks along -y; 0: it stands", at<&Mannequin::speed>, check::non_negative},
    {"walk_from", "s", "when it begins to walk", at<&Mannequin::walks_from>, check::non_negative},
};

}  // namespace

const ShapeKind shapes::mannequin{.name = "mannequin",
                                  .description = "a figure of 1.7 m, made of round cones, that stands or walks",
                                  .smooth = true,
                                  .create = create<Mannequin>,
                                  .keys = keys_in<mannequin_keys>};

}  // namespace drape::model
