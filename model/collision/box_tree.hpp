#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <span>
#include <vector>

namespace drape::model {

/// Boxes along the axes around any primitives, in a binary tree with one primitive in each leaf, to find those that are near.
/// The tree is built once: when primitives move, its boxes are fitted to theirs. Nothing but the constructor allocates.
class BoxTree {
 public:
  /// The primitives are halved where their centres spread farthest [m].
  explicit BoxTree(const std::vector<Eigen::Vector3d>& centres);

  /// Fits the tree to the boxes of its primitives [m].
  void refit(std::span<const Eigen::AlignedBox3d> boxes);

  /// Calls visit(i) for each primitive i whose box overlaps `box` or touches it.
  template <class Visit>
  void overlapping(const Eigen::AlignedBox3d& box, const Visit& visit) const {
    if (!nodes_.empty()) descend(0, box, visit);
  }

  std::int64_t nodes() const { return std::ssize(nodes_); }

  /// Calls visit(i, j) once for each pair of primitives i < j whose boxes do.
  template <class Visit>
  void overlapping_pairs(const Visit& visit) const {
    overlapping_pairs(0, nodes(), visit);
  }

  /// Those between the halves of the nodes [begin, end): the pairs in a part of the tree are those in its halves and those
  /// between them.
  template <class Visit>
  void overlapping_pairs(std::int64_t begin, std::int64_t end, const Visit& visit) const {
    const auto in_order = [&](int i, int j) { visit(std::min(i, j), std::max(i, j)); };
    for (int at = static_cast<int>(begin); at < end; ++at)
      if (nodes_[at].right > 0) descend(at + 1, *this, nodes_[at].right, in_order);
  }

  /// Calls visit(i, j) for each primitive i of this tree and j of the other whose boxes do.
  template <class Visit>
  void overlapping_pairs(const BoxTree& other, const Visit& visit) const {
    if (!nodes_.empty() && !other.nodes_.empty()) descend(0, other, 0, visit);
  }

 private:
  /// Its left child follows it.
  struct Node {
    Eigen::AlignedBox3d box;
    int right;      ///< child; 0: it is a leaf
    int primitive;  ///< of a leaf
  };

  int build(std::span<int> primitives, const std::vector<Eigen::Vector3d>& centres);

  /// AlignedBox3d::intersects without its branches: half of the boxes overlap, in no order.
  static bool overlap(const Eigen::AlignedBox3d& one, const Eigen::AlignedBox3d& other) {
    int all = 1;
    for (int c = 0; c < 3; ++c) all &= int{one.min()[c] <= other.max()[c]} & int{other.min()[c] <= one.max()[c]};
    return all != 0;
  }

  template <class Visit>
  void descend(int at, const Eigen::AlignedBox3d& box, const Visit& visit) const {
    const Node& node = nodes_[at];
    if (!overlap(node.box, box)) return;
    if (node.right == 0) return visit(node.primitive);
    descend(at + 1, box, visit);
    descend(node.right, box, visit);
  }

  /// In both trees at once.
  template <class Visit>
  void descend(int at, const BoxTree& other, int there, const Visit& visit) const {
    const Node &node = nodes_[at], &opposite = other.nodes_[there];
    if (!overlap(node.box, opposite.box)) return;
    if (node.right == 0 && opposite.right == 0) return visit(node.primitive, opposite.primitive);
    if (node.right == 0) {
      descend(at, other, there + 1, visit);
      descend(at, other, opposite.right, visit);
    } else if (opposite.right == 0) {
      descend(at + 1, other, there, visit);
      descend(node.right, other, there, visit);
    } else {
      descend(at + 1, other, there + 1, visit);
      descend(at + 1, other, opposite.right, visit);
      descend(node.right, other, there + 1, visit);
      descend(node.right, other, opposite.right, visit);
    }
  }

  std::vector<Node> nodes_;
};

}  // namespace drape::model
