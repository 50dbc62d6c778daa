#include "model/collision/box_tree.hpp"

#include <numeric>

namespace drape::model {

BoxTree::BoxTree(const std::vector<Eigen::Vector3d>& centres) {
  std::vector<int> primitives(centres.size());
  std::iota(primitives.begin(), primitives.end(), 0);
  if (!primitives.empty()) build(primitives, centres);
}

/// Returns the node.
int BoxTree::build(std::span<int> primitives, const std::vector<Eigen::Vector3d>& centres) {
  const int at = static_cast<int>(nodes_.size());
  nodes_.push_back({{}, 0, primitives.front()});
  if (primitives.size() == 1) return at;
  Eigen::AlignedBox3d spread;
  for (const int i : primitives) spread.extend(centres[i]);
  Eigen::Index axis = 0;
  spread.sizes().maxCoeff(&axis);
  const auto middle = primitives.begin() + std::ssize(primitives) / 2;
  std::ranges::nth_element(primitives, middle, {}, [&](int i) { return centres[i][axis]; });
  build({primitives.begin(), middle}, centres);
  const int right = build({middle, primitives.end()}, centres);
  nodes_[at].right = right;
  return at;
}

void BoxTree::refit(std::span<const Eigen::AlignedBox3d> boxes) {
  for (int at = static_cast<int>(nodes_.size()) - 1; at >= 0; --at) {  // children stand behind their parents
    Node& node = nodes_[at];
    node.box = node.right == 0 ? boxes[node.primitive] : nodes_[at + 1].box.merged(nodes_[node.right].box);
  }
}

}  // namespace drape::model
