// Where a cloth comes near itself: against all pairs, without boxes and culls; and how many distances that takes.

#include "model/collision/self_contacts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "model/collision/approach.hpp"
#include "model/collision/exact_intersection.hpp"
#include "model/collision/face_distance.hpp"
#include "verify/support/threads.hpp"

namespace drape::verify::self_contacts_test {
namespace {

using Eigen::Vector3d;
using model::Approach;
using model::ClothSurface;
using model::PairKind;
using model::Proximity;
using model::SelfContacts;
using model::Vectors;

using Faces = std::vector<std::array<int, 3>>;

/// What is compared of a pair: which it is, and all its numbers, to the last bit.
using Key = std::tuple<std::array<int, 4>, double, double, std::array<double, 4>>;

Key key(const Proximity& pair, double part = 0) {
  return {pair.particles, part, pair.distance, {pair.weights[0], pair.weights[1], pair.weights[2], pair.weights[3]}};
}

struct Candidate {
  PairKind kind;
  std::array<int, 4> particles;
  bool may_end;  ///< one of the edges is that of a chain
};

/// All pairs without a common particle, from the triangles alone.
std::vector<Candidate> all_candidates(const Faces& faces) {
  std::set<int> vertices;
  std::vector<std::array<int, 2>> edges;  // in the order in which they first occur
  std::set<std::array<int, 2>> of_triangles;
  for (const auto& [a, b, c] : faces)
    for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      vertices.insert(p);
      const std::array<int, 2> edge{std::min(p, q), std::max(p, q)};
      if (p != q && std::ranges::find(edges, edge) == edges.end()) edges.push_back(edge);
      if (b != c) of_triangles.insert(edge);
    }
  const auto disjoint = [](const std::array<int, 4>& p, int firsts) {
    for (int k = 0; k < firsts; ++k)
      for (int m = firsts; m < 4; ++m)
        if (p[k] == p[m]) return false;
    return true;
  };
  std::vector<Candidate> all;
  for (const int v : vertices)
    for (const auto& [a, b, c] : faces)
      if (b != c && disjoint({v, a, b, c}, 1)) all.push_back({PairKind::vertex_face, {v, a, b, c}, false});
  for (auto one = edges.begin(); one != edges.end(); ++one)
    for (auto other = one + 1; other != edges.end(); ++other)
      if (const std::array<int, 4> p{(*one)[0], (*one)[1], (*other)[0], (*other)[1]}; disjoint(p, 2))
        all.push_back({PairKind::edge_edge, p, !of_triangles.contains(*one) || !of_triangles.contains(*other)});
  return all;
}

bool counts(const Candidate& pair, const Proximity& nearest) {
  return pair.kind == PairKind::vertex_face || pair.may_end || nearest.is_inside();
}

/// Faces between a few particles at random places, or a sheet that is crumpled, and how they move.
struct Configuration {
  Faces faces;
  Vectors x0, x1;
  double distance;
};

Configuration soup(std::mt19937& random) {
  constexpr int particles = 12;
  std::uniform_real_distribution<double> coordinate(-0.5, 0.5), moved(-1, 1);
  std::uniform_int_distribution<int> index(0, particles - 1);
  Configuration made{{}, Vectors(particles, 3), Vectors(particles, 3), 0.02 + 0.1 * std::abs(coordinate(random))};
  std::set<std::set<int>> known;  // a surface has no face twice
  while (made.faces.size() < 7) {
    const std::array<int, 3> face{index(random), index(random), index(random)};
    if (face[0] == face[1] || face[0] == face[2] || !known.insert({face.begin(), face.end()}).second) continue;
    made.faces.push_back(face);
  }
  const double way = std::pow(10, -2 * std::abs(moved(random)));
  const Vector3d common(moved(random), moved(random), moved(random));
  for (int i = 0; i < particles; ++i)
    for (int c = 0; c < 3; ++c) {
      made.x0(i, c) = coordinate(random);
      made.x1(i, c) = made.x0(i, c) + common[c] + way * moved(random);
    }
  return made;
}

Configuration crumpled(std::mt19937& random) {
  constexpr int side = 5;
  constexpr double spacing = 0.1;
  std::normal_distribution<double> moved(0, 0.06);
  Configuration made{{}, Vectors(side * side, 3), Vectors(side * side, 3), 0.03};
  for (int b = 0; b < side; ++b)
    for (int a = 0; a < side; ++a) {
      const int i = a + side * b;
      made.x0.row(i) << a * spacing, b * spacing, 0;
      for (int c = 0; c < 3; ++c) made.x0(i, c) += moved(random);
      for (int c = 0; c < 3; ++c) made.x1(i, c) = made.x0(i, c) + moved(random);
      if (a + 1 == side || b + 1 == side) continue;
      made.faces.push_back({i, i + 1, i + side});
      made.faces.push_back({i + side + 1, i + side, i + 1});
    }
  return made;
}

template <class Check>
void for_random_configurations(const Check& check) {
  std::mt19937 random(7);
  for (int k = 0; k < 2500; ++k) {
    const Configuration made = k % 5 == 4 ? crumpled(random) : soup(random);
    solver::Counters work;
    // Where nodes were once is not where they are now.
    SelfContacts contacts(ClothSurface(made.faces, k % 2 == 0 ? made.x0 : Vectors::Random(made.x0.rows(), 3)), work);
    check(made, contacts);
    if (testing::Test::HasFailure()) FAIL() << "configuration " << k;
  }
}

void expect_same(std::vector<Key> found, std::vector<Key> expected) {
  std::ranges::sort(found);
  std::ranges::sort(expected);
  EXPECT_EQ(std::ranges::adjacent_find(found), found.end()) << "a pair twice";
  EXPECT_EQ(found, expected);
}

TEST(SelfContacts, FindsAllPairsThatComeNear) {
  std::size_t pairs = 0, at_begin = 0, edges = 0;
  for_random_configurations([&](const Configuration& made, SelfContacts& contacts) {
    std::vector<Approach> found;
    contacts.find(made.x0, made.x1, made.distance, found);
    std::vector<Key> keys, touches, expected, expected_touches;
    for (const Approach& approach : found) {
      keys.push_back(key(approach.begin, approach.part));
      touches.push_back(key(approach.touch, approach.part));
      at_begin += approach.part == 0 ? 1 : 0;
      edges += approach.kind == PairKind::edge_edge ? 1 : 0;
    }
    for (const Candidate& pair : all_candidates(made.faces)) {
      const auto x0 = model::points_of(pair.particles, made.x0), x1 = model::points_of(pair.particles, made.x1);
      const auto part = model::first_approach(pair.kind, x0, x1, made.distance);
      if (!part) continue;
      const Proximity begin = model::proximity(pair.kind, pair.particles, x0);
      Proximity touch = model::proximity(pair.kind, pair.particles, model::points_between(x0, x1, *part));
      const Proximity last = model::proximity(pair.kind, pair.particles, x1);
      if (last.is_inside() && last.normal.dot(touch.normal) > 0) touch = last;
      if (!counts(pair, touch)) continue;
      const bool leaves = last.distance >= made.distance;
      if (begin.distance < made.distance && leaves && !model::first_approach(pair.kind, x0, x1, 0.999 * begin.distance))
        continue;
      expected.push_back(key(begin, *part));
      expected_touches.push_back(key(touch, *part));
    }
    expect_same(keys, expected);
    expect_same(touches, expected_touches);
    pairs += expected.size();
  });
  EXPECT_GT(pairs, 20000U);
  EXPECT_GT(at_begin, 2000U);
  EXPECT_GT(edges, 5000U);
}

TEST(SelfContacts, KnowsAllPairsThatAreNear) {
  std::size_t pairs = 0;
  for_random_configurations([&](const Configuration& made, SelfContacts& contacts) {
    std::vector<Proximity> found;
    contacts.near(made.x0, made.distance, found);
    std::vector<Key> keys, expected;
    for (const Proximity& pair : found) keys.push_back(key(pair));
    for (const Candidate& pair : all_candidates(made.faces)) {
      const Proximity nearest = model::proximity(pair.kind, pair.particles, model::points_of(pair.particles, made.x0));
      if (nearest.distance < made.distance && counts(pair, nearest)) expected.push_back(key(nearest));
    }
    expect_same(keys, expected);
    pairs += expected.size();
  });
  EXPECT_GT(pairs, 5000U);
}

/// Calls check(i, j, corners, corners) for all pairs of triangles without a common particle.
template <class Check>
void for_all_triangle_pairs(const Configuration& made, const Check& check) {
  const auto corners = [&](const std::array<int, 3>& face) {
    return model::Corners{made.x0.row(face[0]), made.x0.row(face[1]), made.x0.row(face[2])};
  };
  for (int i = 0; i < std::ssize(made.faces); ++i)
    for (int j = i + 1; j < std::ssize(made.faces); ++j) {
      const std::array<int, 3>&one = made.faces[i], &other = made.faces[j];
      const bool is_chain = one[1] == one[2] || other[1] == other[2];
      if (!is_chain && std::ranges::find_first_of(one, other) == one.end()) check(i, j, corners(one), corners(other));
    }
}

TEST(SelfContacts, CountsAllNearPairsOfFaces) {
  int pairs = 0;
  for_random_configurations([&](const Configuration& made, SelfContacts& contacts) {
    int expected = 0;
    for_all_triangle_pairs(made, [&](int, int, const model::Corners& one, const model::Corners& other) {
      double least = HUGE_VAL;
      for (int k = 0; k < 3; ++k) {
        const auto see = [&](PairKind kind, const model::FourPoints& x) {
          least = std::min(least, model::proximity(kind, x).distance);
        };
        see(PairKind::vertex_face, {one[k], other[0], other[1], other[2]});
        see(PairKind::vertex_face, {other[k], one[0], one[1], one[2]});
        for (int m = 0; m < 3; ++m) see(PairKind::edge_edge, {one[k], one[(k + 1) % 3], other[m], other[(m + 1) % 3]});
      }
      expected += least < made.distance || model::intersect(one, other) ? 1 : 0;
    });
    EXPECT_EQ(contacts.face_pairs(made.x0, made.distance), expected);
    pairs += expected;
  });
  EXPECT_GT(pairs, 5000);
}

TEST(SelfContacts, FindsAllIntersections) {
  std::size_t pairs = 0;
  for_random_configurations([&](const Configuration& made, SelfContacts& contacts) {
    std::vector<std::array<int, 2>> found = contacts.intersections(made.x0), expected;
    for_all_triangle_pairs(made, [&](int i, int j, const model::Corners& one, const model::Corners& other) {
      if (model::intersect(one, other)) expected.push_back({i, j});
    });
    std::ranges::sort(found);
    EXPECT_EQ(found, expected);
    pairs += expected.size();
  });
  EXPECT_GT(pairs, 2000U);
}

// --- Cases that are known
// -----------------------------------------------------------------------------------------------------

/// A large triangle at rest and one particle of a small one above or below its middle.
struct AboveAFace {
  Faces faces{{0, 1, 2}, {3, 4, 5}};
  solver::Counters work;

  static Vectors at(double height) {
    Vectors x(6, 3);
    x << -1, -1, 0, 1, -1, 0, 0, 1, 0, 0, 0, height, 0.1, 0, height + 5, 0, 0.1, height + 5;
    return x;
  }

  std::vector<Approach> find(double from, double to) {
    SelfContacts contacts(ClothSurface(faces, at(1)), work);
    std::vector<Approach> found(3);
    contacts.find(at(from), at(to), 0.1, found);
    return found;
  }
};

TEST(SelfContacts, HaveTheNearestPointsAtBothTimes) {
  const auto found = AboveAFace().find(0.5, -0.5);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].part, 0.4, 1e-5);
  EXPECT_LE(found[0].part, 0.4);
  EXPECT_THAT(found[0].begin.particles, testing::ElementsAre(3, 0, 1, 2));
  EXPECT_NEAR(found[0].begin.distance, 0.5, 1e-15);
  EXPECT_NEAR(found[0].touch.distance, 0.1, 1.1e-5);
  EXPECT_NEAR(found[0].touch.normal.z(), 1, 1e-15);
  EXPECT_TRUE(AboveAFace().find(0.5, 0.2).empty());
}

TEST(SelfContacts, LeaveOutPairsThatPart) {
  EXPECT_TRUE(AboveAFace().find(0.05, 0.2).empty());
  EXPECT_EQ(AboveAFace().find(0.05, 0.09).size(), 1U) << "it is still near";
  EXPECT_EQ(AboveAFace().find(0.05, -0.2).size(), 1U) << "it comes nearer on the way";
  EXPECT_EQ(AboveAFace().find(0.05, -0.2)[0].part, 0);
}

TEST(SelfContacts, OfChainsCountWhereTheyEnd) {
  const Faces chains{{0, 1, 1}, {2, 3, 3}};
  Vectors x(4, 3);
  x << 0, 0, 0, 1, 0, 0, 1.05, 0, 0, 2, 0, 0;
  solver::Counters work;
  SelfContacts contacts(ClothSurface(chains, x), work);
  std::vector<Proximity> found;
  contacts.near(x, 0.1, found);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].distance, 0.05, 1e-15);
  EXPECT_EQ(contacts.face_pairs(x, 0.1), 0) << "they are not triangles";
}

TEST(SelfContacts, IntersectWhereAVertexTouches) {
  Faces faces{{0, 1, 2}, {3, 4, 5}};
  solver::Counters work;
  SelfContacts contacts(ClothSurface(faces, AboveAFace::at(1)), work);
  EXPECT_THAT(contacts.intersections(AboveAFace::at(0)), testing::ElementsAre(std::array{0, 1}));
  EXPECT_THAT(contacts.intersections(AboveAFace::at(1e-200)), testing::IsEmpty());
}

// --- Threads
// ---------------------------------------------------------------------------------------------------------------------

/// A sheet of 61 × 61 particles, 2 cm apart, folded so that its halves lie 3 mm above each other and pass through each other.
TEST(SelfContacts, AreTheSameForAnyNumberOfThreads) {
  constexpr int n = 61;
  Faces faces;
  Vectors x0(n * n, 3), x1(n * n, 3);
  for (int b = 0; b < n; ++b)
    for (int a = 0; a < n; ++a) {
      const int i = a + n * b, folded = std::min(a, n - 1 - a);
      const double height = a < n / 2 ? 0.003 : 0;
      x0.row(i) << 0.02 * folded, 0.02 * b, height;
      x1.row(i) << 0.02 * folded, 0.021 * b, -height + 1e-4 * std::sin(i);
      if (a + 1 == n || b + 1 == n) continue;
      faces.push_back({i, i + 1, i + n});
      faces.push_back({i + n + 1, i + n, i + 1});
    }
  const auto find = [&](int threads) {
    const Threads allowed(threads);
    EXPECT_EQ(base::threads_for(20 * std::ssize(faces)), threads) << "or this test tests nothing";
    solver::Counters work;
    SelfContacts contacts(ClothSurface(faces, x0), work);
    std::vector<Approach> found;
    contacts.find(x0, x1, 2e-3, found);
    std::vector<Key> pairs;
    for (const Approach& pair : found) pairs.push_back(key(pair.touch, pair.part));
    return std::pair(pairs, work.count("self_pairs"));
  };
  const auto by_one = find(1);
  EXPECT_GT(by_one.first.size(), 1000U);
  for (const int threads : {2, 3, 7}) EXPECT_EQ(find(threads), by_one) << threads << " threads";
}

// --- Work
// ---------------------------------------------------------------------------------------------------------------------

/// n × n particles, 2 cm apart, that lie askew and fall by 1.5 cm in waves of 1 cm; `found` within 4 mm.
struct FlatSheet {
  Faces faces;
  Vectors x0, x1;

  explicit FlatSheet(int n) : x0(n * n, 3), x1(n * n, 3) {
    const Eigen::Matrix3d turned = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).matrix();
    for (int b = 0; b < n; ++b)
      for (int a = 0; a < n; ++a) {
        const int i = a + n * b;
        const Vector3d flat(0.02 * a, 0.02 * b, 0);
        x0.row(i) = turned * flat;
        x1.row(i) = turned * (flat - Vector3d(0, 0, 0.015 + 0.01 * std::sin(20 * flat.x())));
        if (a + 1 == n || b + 1 == n) continue;
        faces.push_back({i, i + 1, i + n});
        faces.push_back({i + n + 1, i + n, i + 1});
      }
  }
};

TEST(SelfContacts, TakeOneDistanceATriangleOfFlatClothWhateverItsSize) {
  for (const int n : {23, 71, 224}) {
    const FlatSheet sheet(n);
    solver::Counters work;
    SelfContacts contacts(ClothSurface(sheet.faces, sheet.x0), work);
    std::vector<Approach> found;
    contacts.find(sheet.x0, sheet.x1, 4e-3, found);
    EXPECT_TRUE(found.empty());
    const double triangles = static_cast<double>(sheet.faces.size());
    EXPECT_LT(static_cast<double>(work.count("self_pairs")), 1.2 * triangles) << triangles << " triangles";
    EXPECT_GT(work.count("self_pairs"), 0);
    std::vector<Proximity> near;
    contacts.near(sheet.x0, 4e-3, near);
    EXPECT_TRUE(near.empty());
    EXPECT_LT(static_cast<double>(work.count("self_pairs")), 2.4 * triangles) << "as many at rest";
  }
}

}  // namespace
}  // namespace drape::verify::self_contacts_test
