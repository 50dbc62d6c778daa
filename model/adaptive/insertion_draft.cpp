#include "model/adaptive/insertion_draft.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

namespace drape::model {
namespace {

using Eigen::Vector3d;

int side_of(const EdgeMesh& mesh, int triangle, int edge) {
  const auto& sides = mesh.sides(triangle);
  return static_cast<int>(std::ranges::find(sides, edge) - sides.begin());
}

/// Numbers what was drafted.
class Assembly {
 public:
  explicit Assembly(FacePrisms& prisms)
      : prisms_(prisms), sheet_(prisms.sheet()), x_(prisms.x()), places_(sheet_.triangles().size(), -1) {}

  int add_inside(int face, const VirtualParticle& particle) {
    const int number = add(particle);
    hit(face).points.push_back({number, prisms_.of(face).projection().barycentric(particle.position)});
    return number;
  }

  /// Adds particles on an edge in their order, returns their numbers. Those that coincide along the edge become one, those
  /// above a node the node.
  std::vector<int> add_along(int number, const std::vector<VirtualParticle>& particles, const std::vector<double>& parameters) {
    const EdgeMesh::Edge& edge = sheet_.edges()[number];
    const double least = on_plane / (x_.row(edge.ends[1]) - x_.row(edge.ends[0])).norm();
    HitEdge inserted{number, {}, {}};
    std::vector<int> numbers;
    for (std::size_t k = 0; k < particles.size(); ++k) {
      const double before = inserted.parameters.empty() ? 0 : inserted.parameters.back();
      if (1 - parameters[k] <= least) {
        numbers.push_back(edge.ends[1]);
      } else if (parameters[k] - before <= least) {
        numbers.push_back(inserted.particles.empty() ? edge.ends[0] : inserted.particles.back());
      } else {
        numbers.push_back(inserted.particles.emplace_back(add(particles[k])));
        inserted.parameters.push_back(parameters[k]);
      }
    }
    if (inserted.particles.empty()) return numbers;
    for (const int face : edge.triangles)
      if (face >= 0) add_to_border(hit(face), inserted);
    all_.edges.push_back(std::move(inserted));
    return numbers;
  }

  /// Adds a particle in a separating plane that the neighbour does not see: inside the face, and nearer to the border than
  /// anything else. As the square of the distance from the next shared particle, so that those farther off are not between one
  /// and the border.
  int add_beside(int face, int edge, const VirtualParticle& particle) {
    constexpr double near = 1e-4;
    const int number = add(particle);
    const int k = side_of(sheet_, face, edge), next = (k + 1) % 3, opposite = (k + 2) % 3;
    const double image = prisms_.along(face, edge, particle.position).value();
    double distance = std::min(image, 1 - image);
    const bool forward = sheet_.edges()[edge].triangles[0] == face;
    for (const int other : hit(face).borders[k])
      distance = std::min(distance, std::abs(image - barycentric(face, other)[forward ? next : k]));
    Vector3d place;
    place[opposite] = near * distance * distance;
    place[forward ? next : k] = image * (1 - place[opposite]);
    place[forward ? k : next] = (1 - image) * (1 - place[opposite]);
    hit(face).points.push_back({number, place});
    return number;
  }

  void add_segment(int face, const std::array<int, 2>& ends, const std::array<double, 2>& parameters, int edge) {
    const Vector3d from = barycentric(face, ends[0]), to = barycentric(face, ends[1]);
    if (ends[0] == ends[1] || (from + to).minCoeff() == 0) return;  // a point, or along an edge of the face
    const FaceProjection& projection = prisms_.of(face).projection();
    const double ratio = projection.weights(position(ends[1])).sum() / projection.weights(position(ends[0])).sum();
    hit(face).segments.push_back({ends, edge, parameters, ratio});
  }

  Insertion finished() {
    std::ranges::sort(all_.faces, {}, &HitFace::face);
    return std::move(all_);
  }

 private:
  HitFace& hit(int face) {
    int& place = places_[face];
    if (place < 0) place = static_cast<int>(all_.faces.size()), all_.faces.push_back({face, {}, {}, {}});
    return all_.faces[place];
  }

  int add(const VirtualParticle& particle) {
    all_.particles.push_back(particle);
    return static_cast<int>(x_.rows() + std::ssize(all_.particles)) - 1;
  }

  void add_to_border(HitFace& hit, const HitEdge& edge) {
    const int k = side_of(sheet_, hit.face, edge.edge), next = (k + 1) % 3;
    const bool forward = sheet_.edges()[edge.edge].triangles[0] == hit.face;
    const std::vector<double> images = images_in(hit.face, edge);
    for (std::size_t i = 0; i < edge.particles.size(); ++i) {
      Vector3d place = Vector3d::Zero();
      place[forward ? next : k] = images[i];
      place[forward ? k : next] = 1 - images[i];
      hit.points.push_back({edge.particles[i], place});
    }
    hit.borders[k] = edge.particles;
    if (!forward) std::ranges::reverse(hit.borders[k]);
  }

  /// Parameters of the images of particles on an edge in the projection of a face, or those of the edge where these are not in
  /// order: where a face does not see all of them.
  std::vector<double> images_in(int face, const HitEdge& edge) {
    std::vector<double> images;
    for (const int particle : edge.particles) {
      const auto image = prisms_.along(face, edge.edge, position(particle));
      if (!image || *image <= (images.empty() ? 0 : images.back()) || *image >= 1) return edge.parameters;
      images.push_back(*image);
    }
    return images;
  }

  Vector3d position(int number) const {
    const int nodes = static_cast<int>(x_.rows());
    return number < nodes ? Vector3d(x_.row(number)) : all_.particles[number - nodes].position;
  }

  Vector3d barycentric(int face, int number) {
    const auto& corners = sheet_.triangles()[face];
    if (const auto corner = std::ranges::find(corners, number); corner != corners.end())
      return Vector3d::Unit(corner - corners.begin());
    return std::ranges::find(hit(face).points, number, &FacePoint::particle)->barycentric;
  }

  FacePrisms& prisms_;
  const EdgeMesh& sheet_;
  const solver::Vectors& x_;
  std::vector<int> places_;  ///< of hit faces in those of `all_`; −1: not there
  Insertion all_;
};

}  // namespace

std::optional<double> FacePrisms::along(int face, int edge, const Vector3d& point) {
  const Vector3d weights = of(face).projection().weights(point);
  const int k = side_of(sheet_, face, edge), next = (k + 1) % 3;
  const double both = weights[k] + weights[next];
  if (both <= 0) return {};
  return weights[sheet_.edges()[edge].triangles[0] == face ? next : k] / both;
}

void InsertionDraft::add(int face, const End& from, const End& to) {
  segments_.push_back(
      {face, from.particle.edge, {point(face, from), point(face, to)}, {from.particle.parameter, to.particle.parameter}});
}

/// The number of a point in `points_`.
int InsertionDraft::point(int face, const End& end) {
  const bool on_side = end.plane >= FacePrism::first_side, shared = on_side && end.shared;
  const int edge = on_side ? prisms_.sheet().sides(face)[end.plane - FacePrism::first_side] : -1;
  // A vertex of the obstacle is one point, whichever of its edges ends there.
  const Key key{shared ? -1 : face, edge, end.vertex < 0 ? -1 - end.particle.edge : end.vertex};
  const auto [found, is_new] = numbers_.try_emplace(key, static_cast<int>(points_.size()));
  if (is_new) points_.push_back({end.particle, key[0], edge, shared ? along(edge, end.particle.position) : 0});
  return found->second;
}

/// The place of a point of a separating plane along the edge, from 0 to 1. Its images from both sides differ, since both
/// centres of projection are in the plane: the mean is in order if both are.
double InsertionDraft::along(int edge, const Vector3d& position) {
  double sum = 0;
  int images = 0;
  for (const int face : prisms_.sheet().edges()[edge].triangles)
    if (const auto image = face < 0 ? std::nullopt : prisms_.along(face, edge, position)) {
      sum += std::clamp(*image, 0.0, 1.0);
      ++images;
    }
  return sum / images;
}

Insertion InsertionDraft::finish() const {
  Assembly assembly(prisms_);
  std::vector<int> numbers(points_.size());
  std::map<int, std::vector<int>> along_edges;
  for (int p = 0; p < std::ssize(points_); ++p) {
    const Point& point = points_[p];
    if (point.edge < 0)
      numbers[p] = assembly.add_inside(point.face, point.particle);
    else if (point.face < 0)
      along_edges[point.edge].push_back(p);
  }
  for (auto& [edge, points] : along_edges) {
    std::ranges::sort(points, {}, [&](int p) { return std::pair(points_[p].along, p); });
    std::vector<VirtualParticle> particles;
    std::vector<double> parameters;
    for (const int p : points) {
      particles.push_back(points_[p].particle);
      parameters.push_back(points_[p].along);
    }
    const std::vector<int> added = assembly.add_along(edge, particles, parameters);
    for (std::size_t k = 0; k < points.size(); ++k) numbers[points[k]] = added[k];
  }
  for (int p = 0; p < std::ssize(points_); ++p)
    if (const Point& point = points_[p]; point.face >= 0 && point.edge >= 0)
      numbers[p] = assembly.add_beside(point.face, point.edge, point.particle);
  for (const auto& [face, edge, points, parameters] : segments_)
    assembly.add_segment(face, {numbers[points[0]], numbers[points[1]]}, parameters, edge);
  return assembly.finished();
}

}  // namespace drape::model
