// Virtual particles of sheets over boxes and balls, and the meshes that they make.

#include "model/adaptive/virtual_particles.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <map>
#include <memory_resource>
#include <random>
#include <set>
#include <string>

#include "model/adaptive/refined_sheet.hpp"
#include "model/adaptive/surface_march.hpp"
#include "model/collision/exact_intersection.hpp"
#include "verify/support/sheet_over_body.hpp"

namespace drape::verify::virtual_particles_test {
namespace {

using Eigen::Vector3d;
using model::Corners;
using model::EdgeMesh;
using model::Insertion;
using model::RefinedSheet;
using model::TriangleMesh;
using model::VirtualParticles;
using solver::Vectors;

/// A sheet and a body, what is inserted and the mesh that is made.
struct Refinement {
  solver::Counters work;
  VirtualParticles search;
  Insertion insertion;
  RefinedSheet refined;
  Vectors x;

  Refinement(const TriangleSheet& sheet, const TriangleMesh& body)
      : search(sheet.faces, sheet.x, body, work),
        insertion(search.find(sheet.x, body.vertices)),
        refined(model::refine(search.sheet(), sheet.x, insertion)),
        x(sheet.x) {}

  Corners corners(const std::array<int, 3>& triangle) const {
    return {refined.position(triangle[0], x), refined.position(triangle[1], x), refined.position(triangle[2], x)};
  }
};

/// Whether a part of the body is in front of a node: in the cone between the corners of the prisms around it.
bool covers_a_node(const SheetOverBody& scene, const VirtualParticles& search) {
  model::FacePrisms prisms(search.sheet(), scene.sheet.x);
  std::vector<std::vector<Vector3d>> lines(scene.sheet.x.rows());
  for (int face = 0; face < std::ssize(scene.sheet.faces); ++face)
    for (const int node : scene.sheet.faces[face])
      lines[node].push_back(2 * prisms.of(face).projection().away(scene.sheet.x.row(node)));
  for (std::size_t node = 0; node < lines.size(); ++node) {
    const Vector3d x = scene.sheet.x.row(node), wide(1e-6, 2e-6, 0);
    for (auto one = lines[node].begin(); one != lines[node].end(); ++one)
      for (auto other = one; other != lines[node].end(); ++other)
        for (const std::array<int, 3>& triangle : scene.body.triangles)
          if (model::intersect({x, x + *one - wide, x + *other + wide}, corners(scene.body, triangle))) return true;
  }
  return false;
}

/// Number of pairs of triangles that have a point in common, once the body is smaller by a billionth: so that touching does not
/// count.
int intersections(const Refinement& made, const std::vector<std::array<int, 3>>& triangles, TriangleMesh body,
                  const Vector3d& centre) {
  for (Vector3d& vertex : body.vertices) vertex = centre + (1 - 1e-9) * (vertex - centre);
  int count = 0;
  for (const std::array<int, 3>& triangle : triangles)
    for (const std::array<int, 3>& other : body.triangles)
      count += model::intersect(made.corners(triangle), corners(body, other)) ? 1 : 0;
  return count;
}

/// Calls check(scene, refinement) for many random scenes.
template <class Check>
void for_random_scenes(int scenes, const Check& check) {
  std::mt19937 random(11);
  for (int k = 0; k < scenes; ++k) {
    const SheetOverBody scene = random_sheet_over_body(random);
    check(scene, Refinement(scene.sheet, scene.body));
    if (testing::Test::HasFailure()) FAIL() << "scene " << k;
  }
}

// --- Known cases ------------------------------------------------------------------------------------------------------

/// Two particles above a box, two beside it and below its top, which ends at x = 0.
struct FourOverAnEdge {
  TriangleSheet sheet{2};
  TriangleMesh box = box_mesh({4, 6, 1});

  FourOverAnEdge() {
    sheet.x << -1, -1, 0.01, 1, -1, -0.99, -1, 1, 0.01, 1, 1, -0.99;
    for (Vector3d& vertex : box.vertices) vertex += Vector3d(-2, 0, -0.5);
  }
};

/// [Etzmuß 2002, fig. 5.11]
TEST(VirtualParticles, AreThreeOnTheEdgesOfFourParticlesOverABox) {
  const FourOverAnEdge scene;
  const Refinement made(scene.sheet, scene.box);
  ASSERT_EQ(made.insertion.particles.size(), 3U);
  ASSERT_EQ(made.insertion.edges.size(), 3U);
  for (const model::HitEdge& hit : made.insertion.edges) {
    const EdgeMesh::Edge& edge = made.search.sheet().edges()[hit.edge];
    const Vector3d v = made.refined.position(hit.particles.at(0), made.x);
    EXPECT_NEAR(v.x(), 0, 1e-15);
    EXPECT_NEAR(v.z(), 0, 1e-15);
    // All faces are in one plane: the image is the nearest point.
    const Vector3d from = made.x.row(edge.ends[0]), along = Vector3d(made.x.row(edge.ends[1])) - from;
    EXPECT_NEAR(hit.parameters.at(0), along.dot(v - from) / along.squaredNorm(), 1e-14);
  }
  EXPECT_EQ(made.refined.triangles.size(), 6U);
  EXPECT_EQ(made.insertion.faces.size(), 2U);
  for (const model::HitFace& hit : made.insertion.faces) EXPECT_EQ(hit.segments.size(), 1U);
}

TEST(VirtualParticles, DividesOnlyTheFacesThatAreHit) {
  TriangleSheet sheet(5);
  TriangleMesh box = box_mesh({0.1, 0.1, 0.1});
  for (Vector3d& vertex : box.vertices) vertex += Vector3d(0.15, 0.15, 0);
  const Refinement made(sheet, box);
  ASSERT_EQ(made.insertion.faces.size(), 1U);
  EXPECT_EQ(made.insertion.particles.size(), 4U) << "the corners of the top; sides are not seen from above";
  EXPECT_TRUE(made.insertion.edges.empty());
  EXPECT_EQ(made.refined.triangles.size(), sheet.faces.size() + 8);
  for (std::size_t k = 0; k < made.refined.triangles.size(); ++k)
    EXPECT_EQ(made.refined.triangles[k] == sheet.faces[made.refined.parents[k]],
              made.refined.parents[k] != made.insertion.faces[0].face);
}

/// [Etzmuß 2002, fig. 5.9]: the sheet is below the box, above it, beside it, or upside down in it.
TEST(VirtualParticles, AreNotThereOnTheFarSide) {
  for (const Vector3d& place : {Vector3d(0.1, 0.2, 0.6), Vector3d(0.1, 0.2, -0.6), Vector3d(3, 0, 0), Vector3d(0.1, 0.2, 0.5),
                                Vector3d(0.1, 0.2, -0.5)}) {
    TriangleMesh box = box_mesh({1, 1, 1});
    for (Vector3d& vertex : box.vertices) vertex += place;
    EXPECT_TRUE(Refinement(TriangleSheet(2), box).insertion.particles.empty()) << place.transpose();
    EXPECT_TRUE(Refinement(TriangleSheet(4), box).insertion.particles.empty()) << place.transpose();
  }
}

/// A box whose sides lean outward: from its upper edges the rays of step 5 leave it at once.
TEST(VirtualParticles, AreThereWhereTheBoxOverhangs) {
  TriangleMesh box = box_mesh({0.5, 0.5, 0.5});
  for (Vector3d& vertex : box.vertices)
    if (vertex.z() > 0) vertex.head<2>() *= 1.2;
  const Refinement made(TriangleSheet(2), box);
  EXPECT_GE(made.insertion.particles.size(), 4U);
  EXPECT_EQ(intersections(made, made.refined.triangles, box, Vector3d::Zero()), 0);
  for (const model::VirtualParticle& particle : made.insertion.particles) EXPECT_NEAR(particle.position.z(), 0.25, 1e-15);
}

// --- Random scenes ----------------------------------------------------------------------------------------------------

TEST(VirtualParticles, LeaveNoIntersection) {
  int before = 0, hit = 0, covered = 0;
  for_random_scenes(400, [&](const SheetOverBody& scene, const Refinement& made) {
    if (covers_a_node(scene, made.search)) {
      ++covered;
      return;
    }
    EXPECT_EQ(intersections(made, made.refined.triangles, scene.body, scene.centre), 0);
    before += intersections(made, scene.sheet.faces, scene.body, scene.centre);
    hit += made.insertion.faces.empty() ? 0 : 1;
  });
  EXPECT_GT(before, 4000);
  EXPECT_GT(hit, 250);
  EXPECT_LT(covered, 20);
}

TEST(VirtualParticles, LieOnEdgesOfTheBodyAndProjectToTheirPlaces) {
  std::size_t points = 0;
  for_random_scenes(100, [&](const SheetOverBody& scene, const Refinement& made) {
    const auto on_edge = [&](const model::VirtualParticle& particle) {
      const auto& [from, to] = made.search.obstacle().edges()[particle.edge].ends;
      return Vector3d(scene.body.vertices[from] + particle.parameter * (scene.body.vertices[to] - scene.body.vertices[from]));
    };
    for (const model::VirtualParticle& particle : made.refined.particles)
      EXPECT_NEAR((on_edge(particle) - particle.position).norm(), 0, 1e-14);
    for (const model::HitFace& hit : made.insertion.faces) {
      const model::FacePrism prism(made.search.sheet(), made.x, hit.face);
      for (const model::FacePoint& point : hit.points) {
        const Vector3d place = prism.projection().barycentric(made.refined.position(point.particle, made.x));
        EXPECT_NEAR((place - point.barycentric).norm(), 0, 2e-4) << "moved away from the border at most";
        const bool inside = point.barycentric.minCoeff() > 1e-4;
        EXPECT_TRUE(!inside || place == point.barycentric);
        ++points;
      }
      for (const model::FaceSegment& segment : hit.segments) {
        const auto image = [&](const Vector3d& p) { return prism.projection().barycentric(p); };
        const Vector3d from = made.refined.position(segment.ends[0], made.x),
                       to = made.refined.position(segment.ends[1], made.x);
        const Vector3d lifted = from + model::lift(0.3, segment.ratio) * (to - from);
        EXPECT_NEAR((image(lifted) - 0.7 * image(from) - 0.3 * image(to)).norm(), 0, 1e-12);
      }
    }
  });
  EXPECT_GT(points, 2000U);
}

/// Each edge of the mesh has one triangle on each side, those along the border of the sheet one alone, and there are no holes.
TEST(VirtualParticles, ConformInFacesThatAreNeighbours) {
  for_random_scenes(200, [&](const SheetOverBody&, const Refinement& made) {
    const EdgeMesh mesh("the refined sheet", made.refined.triangles);
    std::set<std::array<int, 2>> border, expected;
    std::set<int> used;
    for (const EdgeMesh::Edge& edge : mesh.edges())
      if (edge.triangles[1] < 0) border.insert(edge.ends);
    for (const std::array<int, 3>& triangle : made.refined.triangles) used.insert(triangle.begin(), triangle.end());
    std::map<int, std::vector<int>> inserted;
    for (const model::HitEdge& hit : made.insertion.edges) inserted[hit.edge] = hit.particles;
    for (int e = 0; e < std::ssize(made.search.sheet().edges()); ++e) {
      const EdgeMesh::Edge& edge = made.search.sheet().edges()[e];
      if (edge.triangles[1] >= 0) continue;
      std::vector<int> chain = inserted[e];
      chain.insert(chain.begin(), edge.ends[0]);
      chain.push_back(edge.ends[1]);
      for (std::size_t k = 1; k < chain.size(); ++k) expected.insert({chain[k - 1], chain[k]});
    }
    EXPECT_EQ(border, expected);
    EXPECT_EQ(std::ssize(used) - std::ssize(mesh.edges()) + std::ssize(mesh.triangles()), 1) << "a disc";
  });
}

TEST(VirtualParticles, AreInOrderOnEdges) {
  std::size_t edges = 0;
  for_random_scenes(200, [&](const SheetOverBody&, const Refinement& made) {
    for (const model::HitEdge& hit : made.insertion.edges) {
      EXPECT_EQ(hit.parameters.size(), hit.particles.size());
      EXPECT_GT(hit.parameters.front(), 0);
      EXPECT_LT(hit.parameters.back(), 1);
      EXPECT_EQ(std::ranges::adjacent_find(hit.parameters, std::greater_equal()), hit.parameters.end());
      ++edges;
    }
  });
  EXPECT_GT(edges, 200U);
}

void expect_equal(const Insertion& one, const Insertion& other) {
  ASSERT_EQ(one.particles.size(), other.particles.size());
  for (std::size_t k = 0; k < one.particles.size(); ++k) {
    EXPECT_EQ(one.particles[k].position, other.particles[k].position);
    EXPECT_EQ(one.particles[k].edge, other.particles[k].edge);
    EXPECT_EQ(one.particles[k].parameter, other.particles[k].parameter);
  }
  ASSERT_EQ(one.faces.size(), other.faces.size());
  for (std::size_t k = 0; k < one.faces.size(); ++k) {
    EXPECT_EQ(one.faces[k].face, other.faces[k].face);
    EXPECT_EQ(one.faces[k].borders, other.faces[k].borders);
    EXPECT_EQ(one.faces[k].points.size(), other.faces[k].points.size());
    EXPECT_EQ(one.faces[k].segments.size(), other.faces[k].segments.size());
  }
}

TEST(VirtualParticles, AreThoseOfAllPairsOfTriangles) {
  std::size_t particles = 0;
  for_random_scenes(200, [&](const SheetOverBody& scene, const Refinement& made) {
    std::int64_t steps = 0;
    model::FacePrisms prisms(made.search.sheet(), made.x);
    std::vector<Vector3d> normals;
    for (const auto& triangle : scene.body.triangles) normals.push_back(model::face_normal(corners(scene.body, triangle)));
    model::SurfaceMarch march(prisms, made.search.obstacle(), scene.body.vertices, normals, *std::pmr::get_default_resource(),
                              steps);
    for (int face = 0; face < std::ssize(scene.sheet.faces); ++face)
      for (int triangle = 0; triangle < std::ssize(scene.body.triangles); ++triangle)
        if (march.can_enter(face, triangle) &&
            model::intersect(made.corners(scene.sheet.faces[face]), corners(scene.body, scene.body.triangles[triangle])))
          march.enter(face, triangle);
    expect_equal(made.insertion, march.insertion());
    EXPECT_EQ(steps, made.work.count("adaptive_steps"));
    particles += made.insertion.particles.size();
  });
  EXPECT_GT(particles, 2000U);
}

/// Against all edges in all prisms of hit faces, without a way over the surface: a convex body is upper on one side only.
TEST(VirtualParticles, AreOnAllUpperEdges) {
  std::size_t edges = 0;
  for_random_scenes(200, [&](const SheetOverBody& scene, const Refinement& made) {
    const EdgeMesh& obstacle = made.search.obstacle();
    for (const model::HitFace& hit : made.insertion.faces) {
      const model::FacePrism prism(made.search.sheet(), made.x, hit.face);
      std::set<int> found, expected;
      for (const model::FaceSegment& segment : hit.segments) found.insert(segment.edge);
      for (int e = 0; e < std::ssize(obstacle.edges()); ++e) {
        const auto& [ends, triangles] = obstacle.edges()[e];
        const Vector3d &from = scene.body.vertices[ends[0]], &to = scene.body.vertices[ends[1]];
        const auto part = model::FacePrism::clip(prism.distances(from), prism.distances(to));
        if (!part) continue;
        const Vector3d away = prism.projection().away(from + 0.5 * (part->begin + part->end) * (to - from));
        const Vector3d n = model::face_normal(corners(scene.body, scene.body.triangles[triangles[0]]));
        const Vector3d m = model::face_normal(corners(scene.body, scene.body.triangles[triangles[1]]));
        if (n.cross(m).norm() > 1e-9 && std::max(n.dot(away), m.dot(away)) > 0) expected.insert(e);
      }
      EXPECT_EQ(found, expected) << "face " << hit.face;
      edges += expected.size();
    }
  });
  EXPECT_GT(edges, 2000U);
}

/// A beam leans over a box: its edges hide parts of those of the box, so that images of segments cross.
TEST(VirtualParticles, AreAddedWhereSegmentsCross) {
  TriangleMesh body = box_mesh({0.3, 0.3, 0.2});
  TriangleMesh beam = box_mesh({0.1, 0.1, 2});
  const int first = static_cast<int>(body.vertices.size());
  for (const Vector3d& vertex : beam.vertices)
    body.vertices.push_back(Eigen::AngleAxisd(1, Vector3d::UnitY()) * vertex - Vector3d(0.5, 0.02, 0));
  for (const auto& [a, b, c] : beam.triangles) body.triangles.push_back({first + a, first + b, first + c});
  const Refinement made(TriangleSheet(2), body);
  EXPECT_GT(made.refined.particles.size(), made.insertion.particles.size());
  for (std::size_t k = made.insertion.particles.size(); k < made.refined.particles.size(); ++k) {
    const model::VirtualParticle& particle = made.refined.particles[k];
    const auto& [from, to] = made.search.obstacle().edges()[particle.edge].ends;
    const Vector3d on_edge = body.vertices[from] + particle.parameter * (body.vertices[to] - body.vertices[from]);
    EXPECT_NEAR((on_edge - particle.position).norm(), 0, 1e-14);
    EXPECT_GE(from, first) << "an edge of the beam, which is above";
  }
}

// --- Cost -------------------------------------------------------------------------------------------------------------

TEST(VirtualParticles, CostWhatTheyHit) {
  std::int64_t steps = 0;
  for (const int n : {10, 40, 160}) {
    const TriangleSheet sheet(n);
    TriangleMesh ball = ball_mesh(0.5 / (n - 1), 2);
    const double between = 1.0 / (n - 1);
    for (Vector3d& vertex : ball.vertices) vertex += Vector3d(n % 2 == 0 ? 0.3 * between : 0, 0, 0.1 * between);
    const Refinement made(sheet, ball);
    EXPECT_GT(made.insertion.particles.size(), 50U);
    if (steps == 0) steps = made.work.count("adaptive_steps");
    EXPECT_NEAR(made.work.count("adaptive_steps"), steps, 10) << n;
    EXPECT_LT(made.work.count("adaptive_pairs"), 100) << n << " of " << sheet.faces.size() * ball.triangles.size();
    for (Vector3d& vertex : ball.vertices) vertex.z() += 1;
    const Refinement apart(sheet, ball);
    EXPECT_EQ(apart.work.count("adaptive_pairs"), 0);
    EXPECT_EQ(apart.work.count("adaptive_steps"), 0);
  }
}

// --- Errors -----------------------------------------------------------------------------------------------------------

/// The message of the error, which is one line.
std::string error_of(const std::vector<std::array<int, 3>>& faces, const TriangleMesh& body) {
  solver::Counters work;
  try {
    VirtualParticles(faces, Vectors::Zero(9, 3), body, work);
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "";
}

TEST(VirtualParticles, NeedAClosedObstacleWithAVolume) {
  const std::vector<std::array<int, 3>> faces{{0, 1, 2}, {3, 2, 1}};
  TriangleMesh box = box_mesh({1, 1, 1});
  box.name = "the box";
  EXPECT_EQ(error_of(faces, box), "");

  TriangleMesh open = box;
  open.triangles.pop_back();
  EXPECT_EQ(error_of(faces, open), "the box: expected a closed mesh, 3 edges of its 11 triangles are open");

  TriangleMesh flat = box;
  for (Vector3d& vertex : flat.vertices) vertex.z() = 0;
  EXPECT_THAT(error_of(faces, flat), testing::StartsWith("the box: expected"));

  TriangleMesh degenerate = box;
  degenerate.vertices[0] = degenerate.vertices[1];
  EXPECT_THAT(error_of(faces, degenerate), testing::StartsWith("the box: expected triangles with an area"));

  TriangleMesh turned = box;
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_THAT(error_of(faces, turned), testing::HasSubstr("agree on which side is outside"));
}

TEST(VirtualParticles, NeedASheetWithAFront) {
  const TriangleMesh box = box_mesh({1, 1, 1});
  EXPECT_EQ(error_of({{0, 1, 2}, {1, 2, 3}}, box),
            "the sheet: expected triangles that agree on which side is the front at the edge from vertex 1 to 2");
  EXPECT_EQ(error_of({{0, 1, 2}, {3, 2, 1}, {4, 2, 1}}, box),
            "the sheet: expected at most two triangles at the edge from vertex 2 to 1");
}

}  // namespace
}  // namespace drape::verify::virtual_particles_test
