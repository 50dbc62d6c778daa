#include "model/collision/exact_intersection.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Intersections_3/Triangle_3_Triangle_3.h>

namespace drape::model {
namespace {

using ExactKernel = CGAL::Exact_predicates_inexact_constructions_kernel;

ExactKernel::Triangle_3 exact(const Corners& corners) {
  const auto point = [](const Eigen::Vector3d& p) { return ExactKernel::Point_3(p.x(), p.y(), p.z()); };
  return {point(corners[0]), point(corners[1]), point(corners[2])};
}

}  // namespace

bool intersect(const Corners& one, const Corners& other) {
  const ExactKernel::Triangle_3 a = exact(one), b = exact(other);
  return !a.is_degenerate() && !b.is_degenerate() && CGAL::do_intersect(a, b);
}

}  // namespace drape::model
