// Cloth comes near edges and corners of bodies between its particles.

#include "model/collision/body_contacts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "verify/support/obstacles.hpp"

namespace drape::verify::body_contacts_test {
namespace {

using model::Approach;
using model::BodyContacts;
using model::ClothSurface;
using model::PairKind;
using model::Vectors;

using Key = std::tuple<std::array<int, 4>, double, double>;

constexpr int side = 5, nodes = side * side;

std::vector<std::array<int, 3>> faces_of_sheet() {
  std::vector<std::array<int, 3>> faces;
  for (int b = 0; b + 1 < side; ++b)
    for (int a = 0; a + 1 < side; ++a) {
      const int i = a + side * b;
      faces.push_back({i, i + 1, i + side});
      faces.push_back({i + side + 1, i + side, i + 1});
    }
  return faces;
}

std::set<std::array<int, 2>> edges_of(const std::vector<std::array<int, 3>>& faces) {
  std::set<std::array<int, 2>> edges;
  for (const auto& [a, b, c] : faces)
    for (const auto& [p, q] : {std::minmax(a, b), std::minmax(b, c), std::minmax(c, a)}) edges.insert({p, q});
  return edges;
}

TEST(BodyContacts, AreAllPairsOfSharpEdgesAndCorners) {
  const std::vector<std::array<int, 3>> faces = faces_of_sheet();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> moved(-0.4, 0.4);
  std::size_t pairs = 0;
  const std::vector<model::ObstacleRule> bodies{
      verify::obstacle("shape = 'box', size = [0.8, 0.6, 0.4], friction = 0.2, motion = [{ time = 0, position = [0, 0, -1] }, "
                       "{ time = 1, position = [0, 0, 0.5], rotation = [0, 20, 40] }]"),
      verify::obstacle("shape = 'box', size = [0.3, 0.5, 0.7], position = [1, 0, -0.5]")};
  Vectors flat(nodes, 3);
  for (int i = 0; i < nodes; ++i) flat.row(i) << 0.4 * (i % side), 0.4 * (i / side) - 0.8, 0;
  solver::Counters work;
  BodyContacts contacts(ClothSurface(faces, flat), bodies, work);
  for (int k = 0; k < 1000; ++k) {
    Vectors x0(nodes, 3), x1(nodes, 3);
    for (int i = 0; i < nodes; ++i)
      for (int c = 0; c < 3; ++c) {
        x0(i, c) = flat(i, c) + moved(random);
        x1(i, c) = x0(i, c) + moved(random);
      }
    const double distance = k / 100 % 2 == 0 ? 0.02 : 0.01;
    const double t = 0.9 * k / 1000, h = 0.1;
    contacts.begin(t, h);
    Vectors y0(nodes + 16, 3), y1(nodes + 16, 3);
    y0 << x0, contacts.points().begin;
    y1 << x1, contacts.points().end;

    std::vector<Key> found, expected;
    contacts.find(x0, x1, distance, [&](const Approach& one, double friction) {
      found.emplace_back(one.begin.particles, one.part, one.touch.distance);
      EXPECT_EQ(friction, one.begin.particles[one.kind == PairKind::edge_edge ? 2 : 0] < nodes + 8 ? 0.2 : 0);
    });
    const auto expect = [&](PairKind kind, const std::array<int, 4>& particles) {
      if (const auto one = model::approach(kind, particles, y0, y1, distance, false))
        expected.emplace_back(particles, one->part, one->touch.distance);
    };
    for (const auto& [a, b, c] : faces)
      for (int v = nodes; v < nodes + 16; ++v) expect(PairKind::vertex_face, {v, a, b, c});
    for (int p = nodes; p < nodes + 16; ++p)
      for (int q = p + 1; q < nodes + 16; ++q) {
        if ((p < nodes + 8) != (q < nodes + 8)) continue;
        const double length = (y0.row(p) - y0.row(q)).norm();
        const std::vector<double> sides = p < nodes + 8 ? std::vector{0.8, 0.6, 0.4} : std::vector{0.3, 0.5, 0.7};
        if (std::ranges::any_of(sides, [&](double s) { return std::abs(length - s) < 1e-9; }))
          for (const auto& [a, b] : edges_of(faces)) expect(PairKind::edge_edge, {a, b, p, q});
      }
    std::ranges::sort(found);
    std::ranges::sort(expected);
    ASSERT_EQ(found, expected) << k;
    pairs += found.size();
  }
  EXPECT_GT(pairs, 3000u);
}

}  // namespace
}  // namespace drape::verify::body_contacts_test
