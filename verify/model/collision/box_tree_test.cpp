// Boxes that overlap, against all pairs.

#include "model/collision/box_tree.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

namespace drape::verify::box_tree_test {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;
using model::BoxTree;
using Pairs = std::vector<std::pair<int, int>>;

/// Cubes of this size, some of which only touch.
std::vector<AlignedBox3d> random_boxes(int count, double size, std::mt19937& random) {
  std::uniform_int_distribution<int> place(0, 20);
  std::vector<AlignedBox3d> boxes;
  for (int k = 0; k < count; ++k) {
    const Vector3d corner = Vector3d(place(random), place(random), place(random)) / 20;
    boxes.emplace_back(corner, corner.array() + size);
  }
  return boxes;
}

BoxTree tree_of(const std::vector<AlignedBox3d>& boxes) {
  std::vector<Vector3d> centres;
  for (const AlignedBox3d& box : boxes) centres.emplace_back(box.center());
  BoxTree tree(centres);
  tree.refit(boxes);
  return tree;
}

Pairs sorted(Pairs pairs) {
  std::ranges::sort(pairs);
  return pairs;
}

void expect_all(const BoxTree& tree, const std::vector<AlignedBox3d>& boxes, const BoxTree& other,
                const std::vector<AlignedBox3d>& others) {
  Pairs own, own_expected, both, both_expected;
  tree.overlapping_pairs([&](int i, int j) { own.emplace_back(i, j); });
  tree.overlapping_pairs(other, [&](int i, int j) { both.emplace_back(i, j); });
  for (int i = 0; i < std::ssize(boxes); ++i) {
    for (int j = i + 1; j < std::ssize(boxes); ++j)
      if (boxes[i].intersects(boxes[j])) own_expected.emplace_back(i, j);
    for (int j = 0; j < std::ssize(others); ++j)
      if (boxes[i].intersects(others[j])) both_expected.emplace_back(i, j);
  }
  EXPECT_EQ(sorted(own), own_expected);
  EXPECT_EQ(sorted(both), both_expected);
  for (int j = 0; j < std::ssize(others); ++j) {
    std::vector<int> found, expected;
    tree.overlapping(others[j], [&](int i) { found.push_back(i); });
    for (int i = 0; i < std::ssize(boxes); ++i)
      if (boxes[i].intersects(others[j])) expected.push_back(i);
    EXPECT_THAT(found, testing::UnorderedElementsAreArray(expected));
  }
}

TEST(BoxTree, FindsAllThatOverlapOnce) {
  std::mt19937 random(1);
  for (const int count : {0, 1, 2, 3, 5, 8, 31, 100})
    for (int k = 0; k < 20; ++k) {
      const std::vector<AlignedBox3d> boxes = random_boxes(count, 0.1, random), others = random_boxes(7, 0.2, random);
      expect_all(tree_of(boxes), boxes, tree_of(others), others);
    }
}

TEST(BoxTree, FollowsItsPrimitives) {
  std::mt19937 random(2);
  const std::vector<AlignedBox3d> others = random_boxes(7, 0.2, random);
  BoxTree tree = tree_of(random_boxes(50, 0.1, random));
  for (int k = 0; k < 20; ++k) {
    const std::vector<AlignedBox3d> boxes = random_boxes(50, 0.15, random);
    tree.refit(boxes);
    expect_all(tree, boxes, tree_of(others), others);
  }
}

TEST(BoxTree, HalvesPrimitivesInOnePlace) {
  const std::vector<AlignedBox3d> boxes(37, AlignedBox3d(Vector3d::Zero(), Vector3d::Ones()));
  int pairs = 0;
  tree_of(boxes).overlapping_pairs([&](int, int) { ++pairs; });
  EXPECT_EQ(pairs, 37 * 36 / 2);
}

}  // namespace
}  // namespace drape::verify::box_tree_test
