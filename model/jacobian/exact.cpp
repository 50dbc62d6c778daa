#include "model/jacobian/exact.hpp"

#include <functional>

namespace drape::model {

void ExactJacobian::Part::analyse(const Blocks& blocks) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const Eigen::Vector2i& block : blocks)
    for_entries(block[0], block[1], [&](int row, int column, int) { entries.emplace_back(row, column, 0); });
  zero.setFromTriplets(entries.begin(), entries.end());
  slots.find(blocks, zero, [](int, int) { return true; });
}

void ExactJacobian::assemble(const VisitBlocks& visit, SparseMatrix& df_dx, SparseMatrix& df_dv) {
  if (!known_) {
    Blocks dx, dv;
    visit({Curvature::exact, recorder(dx), recorder(dv)});
    dx_.analyse(dx);
    dv_.analyse(dv);
    known_ = true;
  }
  df_dx = dx_.zero;
  df_dv = dv_.zero;
  BlockSlots::Adder add_dx(dx_.slots, df_dx.valuePtr(), 1), add_dv(dv_.slots, df_dv.valuePtr(), 1);
  visit({Curvature::exact, std::ref(add_dx), std::ref(add_dv)});
}

}  // namespace drape::model
