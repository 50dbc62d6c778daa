#pragma once

#include <Eigen/Core>
#include <array>
#include <iosfwd>
#include <vector>

namespace drape::model {

/// A mesh of polygons, for looking at.
struct Polygons {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::vector<int>> faces;  ///< corners of a polygon, or the two ends of a line
};

/// The polygons as triangles: each is a fan around its first corner, so they should be convex. Lines have none.
std::vector<std::array<int, 3>> fan_triangles(const Polygons& polygons);

/// Around the origin at z = 0.
Polygons square(double side);

/// A point of a profile: distance from the z axis and height.
struct ProfilePoint {
  double r, z;
};

/// A profile from below to above, turned round the z axis and closed by a lid at either end.
Polygons turned(const std::vector<ProfilePoint>& profile);

/// Triangles between this number of vertices, at least 20, on a sphere of radius 1: two poles and rings about as far apart as
/// their vertices. A closed mesh of n vertices has 3n − 6 edges.
Polygons ringed_sphere(int vertices);

/// In Wavefront's OBJ format, numbers to the last bit.
void write_obj(std::ostream& out, const Polygons& polygons);

}  // namespace drape::model
