#include "model/jacobian/slots.hpp"

#include <algorithm>

namespace drape::model {

JacobianEntries::Add recorder(Blocks& blocks) {
  return [&blocks](int i, int j, const Eigen::Matrix3d&) { blocks.emplace_back(i, j); };
}

void BlockSlots::find(const Blocks& blocks, const SparseMatrix& pattern, const std::function<bool(int, int)>& kept) {
  slots_.clear();
  slots_.reserve(9 * blocks.size());
  const int *const outer = pattern.outerIndexPtr(), *const inner = pattern.innerIndexPtr();
  for (const Eigen::Vector2i& block : blocks)
    for_entries(block[0], block[1], [&](int row, int column, int) {
      const int* const place = std::lower_bound(inner + outer[row], inner + outer[row + 1], column);
      slots_.push_back(kept(row, column) ? static_cast<int>(place - inner) : -1);
    });
}

void BlockSlots::Adder::operator()(int i, int, const Eigen::Matrix3d& block) {
  if (i >= begin_ && i < end_)
    for_entries(0, 0, [&](int a, int b, int k) {
      if (slot_[k] >= 0) values_[slot_[k]] += weight_ * block(a, b);
    });
  skip(1);
}

}  // namespace drape::model
