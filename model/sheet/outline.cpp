#include "model/sheet/outline.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace drape::model {
namespace {

using Eigen::Vector2d;

/// The circle through three points, and the angle that an arc from the first through the second to the third sweeps.
struct Circle {
  Vector2d centre;
  double sweep;

  explicit Circle(const std::vector<Vector2d>& p) {
    const Vector2d a = p[1] - p[0], b = p[2] - p[0];
    const double twice = 2 * (a.x() * b.y() - a.y() * b.x());
    const Vector2d from_first =
        Vector2d(b.y() * a.squaredNorm() - a.y() * b.squaredNorm(), a.x() * b.squaredNorm() - b.x() * a.squaredNorm()) / twice;
    centre = p[0] + from_first;
    const auto angle = [this](const Vector2d& at) { return std::atan2(at.y() - centre.y(), at.x() - centre.x()); };
    sweep = angle(p[2]) - angle(p[0]);
    // Counterclockwise if the three points turn left.
    if (twice > 0 && sweep < 0) sweep += 2 * std::numbers::pi;
    if (twice < 0 && sweep > 0) sweep -= 2 * std::numbers::pi;
  }
};

/// By de Casteljau.
Vector2d bezier_point(std::vector<Vector2d> p, double t) {
  for (std::size_t left = p.size() - 1; left > 0; --left)
    for (std::size_t k = 0; k < left; ++k) p[k] += t * (p[k + 1] - p[k]);
  return p[0];
}

double bezier_speed(const std::vector<Vector2d>& p, double t) {
  std::vector<Vector2d> differences;
  for (std::size_t k = 0; k + 1 < p.size(); ++k)
    differences.emplace_back(static_cast<double>(p.size() - 1) * (p[k + 1] - p[k]));
  return bezier_point(differences, t).norm();
}

/// ∫ speed dt by Gauss' formula with five points, whose error is of order 10.
double bezier_length(const std::vector<Vector2d>& p, double from, double to) {
  constexpr double nodes[] = {0, 0.5384693101056831, 0.906179845938664};
  constexpr double weights[] = {0.5688888888888889, 0.47862867049936647, 0.23692688505618908};
  const double middle = (from + to) / 2, half = (to - from) / 2;
  double sum = weights[0] * bezier_speed(p, middle);
  for (const int k : {1, 2})
    sum += weights[k] * (bezier_speed(p, middle - half * nodes[k]) + bezier_speed(p, middle + half * nodes[k]));
  return half * sum;
}

constexpr int measured_parts = 64;  ///< of a Bézier curve, whose lengths are computed

/// The lengths up to equidistant parameters.
std::vector<double> bezier_lengths(const std::vector<Vector2d>& p) {
  std::vector<double> passed{0};
  for (int k = 0; k < measured_parts; ++k)
    passed.push_back(passed.back() + bezier_length(p, k / double(measured_parts), (k + 1) / double(measured_parts)));
  return passed;
}

/// The parameter at a length. `passed`: as above.
double bezier_parameter(const std::vector<Vector2d>& p, const std::vector<double>& passed, double length) {
  const auto above = std::ranges::upper_bound(passed, length);
  const auto k = static_cast<int>(std::distance(passed.begin(), above)) - 1;
  const double first = k / double(measured_parts);
  const double left = length - passed[k];
  double t = first + left / (passed[k + 1] - passed[k]) / measured_parts;
  double step = 1;
  for (int newton = 0; newton < 20 && std::abs(step) > 1e-15; ++newton) {  // where the curve has a cusp it takes many
    const double speed = bezier_speed(p, t);
    if (!(speed > 0)) break;
    step = std::clamp(t - (bezier_length(p, first, t) - left) / speed, first, (k + 1) / double(measured_parts)) - t;
    t += step;
  }
  return t;
}

/// The lengths up to the points.
std::vector<double> polyline_lengths(const std::vector<Vector2d>& p) {
  std::vector<double> passed{0};
  for (std::size_t k = 0; k + 1 < p.size(); ++k) passed.push_back(passed.back() + (p[k + 1] - p[k]).norm());
  return passed;
}

/// The line of a polyline on which a length below that of the whole ends.
std::size_t line_at(const std::vector<double>& passed, double length) {
  return static_cast<std::size_t>(std::ranges::upper_bound(passed, length) - passed.begin()) - 1;
}

/// Particles on a side.
struct Side {
  std::vector<double> places;  ///< as parts of its length
  std::vector<Vector2d> points;

  /// `given`: the places unless pieces count cells.
  Side(const std::vector<CurvePiece>& pieces, const std::vector<double>& given) : places(given) {
    const Curve curve(pieces);
    if (counted_cells(pieces) > 0) {
      places = {0};
      for (std::size_t k = 0; k < pieces.size(); ++k) {
        const double begin = places.back(), end = curve.length_up_to(k) / curve.length();
        const int cells = pieces[k].cells;
        for (int cell = 1; cell <= cells; ++cell) places.push_back(begin + (end - begin) * cell / cells);
      }
    }
    for (const double place : places) points.push_back(curve.at(place));
  }
};

}  // namespace

Curve::Curve(const std::vector<CurvePiece>& pieces) {
  double end = 0;
  for (const CurvePiece& piece : pieces) {
    std::vector<double> passed;
    switch (piece.kind) {
      case CurvePiece::Kind::line: end += (piece.points[1] - piece.points[0]).norm(); break;
      case CurvePiece::Kind::arc: {
        const Circle circle(piece.points);
        end += std::abs(circle.sweep) * (piece.points[0] - circle.centre).norm();
        break;
      }
      case CurvePiece::Kind::bezier:
        passed = bezier_lengths(piece.points);
        end += passed.back();
        break;
      case CurvePiece::Kind::polyline:
        passed = polyline_lengths(piece.points);
        end += passed.back();
        break;
    }
    pieces_.push_back({piece, end, std::move(passed)});
  }
}

Vector2d Curve::at(double part) const {
  const double wanted = part * length();
  auto found = std::ranges::lower_bound(pieces_, wanted, {}, &Measured::end);
  if (found == pieces_.end()) --found;
  const double begin = found == pieces_.begin() ? 0 : std::prev(found)->end, whole = found->end - begin;
  const std::vector<Vector2d>& p = found->piece.points;
  const double within = std::clamp(wanted - begin, 0.0, whole);
  if (within == 0) return p.front();
  if (within == whole) return p.back();
  const double t = within / whole;
  switch (found->piece.kind) {
    case CurvePiece::Kind::line: return p[0] + t * (p[1] - p[0]);
    case CurvePiece::Kind::arc: {
      const Circle circle(p);
      return circle.centre + Eigen::Rotation2Dd(t * circle.sweep) * (p[0] - circle.centre);
    }
    case CurvePiece::Kind::polyline: {
      const std::size_t k = line_at(found->passed, within);
      return p[k] + (within - found->passed[k]) / (found->passed[k + 1] - found->passed[k]) * (p[k + 1] - p[k]);
    }
    case CurvePiece::Kind::bezier: break;
  }
  return bezier_point(p, bezier_parameter(p, found->passed, within));
}

std::array<CurvePiece, 2> divided(const CurvePiece& piece, double part) {
  const std::vector<Vector2d>& p = piece.points;
  const Curve whole({piece});
  const Vector2d middle = whole.at(part);
  CurvePiece first{piece.kind, {p.front()}}, second{piece.kind, {}};
  switch (piece.kind) {
    case CurvePiece::Kind::line: break;
    case CurvePiece::Kind::arc:
      first.points.push_back(whole.at(part / 2));
      second.points.push_back(whole.at((1 + part) / 2));
      break;
    case CurvePiece::Kind::bezier: {  // the triangle of de Casteljau has the control points of both on its sides
      const std::vector<double> passed = bezier_lengths(p);
      const double t = bezier_parameter(p, passed, part * passed.back());
      std::vector<Vector2d> left = p;
      for (std::size_t count = p.size() - 1; count > 0; --count) {
        for (std::size_t k = 0; k < count; ++k) left[k] += t * (left[k + 1] - left[k]);
        if (count > 1) first.points.push_back(left[0]);
        if (count < p.size() - 1) second.points.insert(second.points.begin(), left[count]);
      }
      break;
    }
    case CurvePiece::Kind::polyline: {
      const std::vector<double> passed = polyline_lengths(p);
      const auto k = static_cast<std::ptrdiff_t>(line_at(passed, part * passed.back()));
      first.points.insert(first.points.end(), p.begin() + 1, p.begin() + k + 1);
      second.points.assign(p.begin() + k + 1, p.end() - 1);
      break;
    }
  }
  first.points.push_back(middle);
  second.points.insert(second.points.begin(), middle);
  second.points.push_back(p.back());
  return {first, second};
}

Outline parallelogram(const Vector2d& u, const Vector2d& v) {
  const auto line = [](const Vector2d& from, const Vector2d& to) -> std::vector<CurvePiece> {
    return {{CurvePiece::Kind::line, {from, to}}};
  };
  const Vector2d origin(0, 0);
  return {.lower = line(origin, u), .upper = line(v, u + v), .left = line(origin, v), .right = line(u, u + v)};
}

std::vector<double> graded(int n, double grading) {
  std::vector<double> places(n, 0.0);
  const double growth = n > 2 ? std::pow(grading, 1.0 / (n - 2)) : 1;
  double spacing = 1;
  for (int a = 1; a < n; ++a, spacing *= growth) places[a] = places[a - 1] + spacing;
  const double whole = n > 1 ? places.back() : 1;
  for (double& place : places) place /= whole;
  return places;
}

std::int64_t counted_cells(const std::vector<CurvePiece>& side) {
  std::int64_t sum = 0;
  for (const CurvePiece& piece : side) sum += piece.cells;
  return sum;
}

solver::Vectors transfinite(const Outline& outline, const std::vector<double>& u, const std::vector<double>& v) {
  const Side lower(outline.lower, u), upper(outline.upper, u), left(outline.left, v), right(outline.right, v);
  const auto nu = static_cast<Eigen::Index>(u.size()), nv = static_cast<Eigen::Index>(v.size());
  solver::Vectors all(nu * nv, 3);
  for (Eigen::Index b = 0; b < nv; ++b)
    for (Eigen::Index a = 0; a < nu; ++a) {
      const double du = upper.places[a] - lower.places[a], dv = right.places[b] - left.places[b];
      const double s = (lower.places[a] + left.places[b] * du) / (1 - du * dv), t = left.places[b] + s * dv;
      const Vector2d sides = (1 - t) * lower.points[a] + t * upper.points[a] + (1 - s) * left.points[b] + s * right.points[b];
      const Vector2d corners = (1 - t) * ((1 - s) * lower.points.front() + s * lower.points.back()) +
                               t * ((1 - s) * upper.points.front() + s * upper.points.back());
      all.row(a + nu * b) << (sides - corners).transpose(), 0;
    }
  return all;
}

}  // namespace drape::model
