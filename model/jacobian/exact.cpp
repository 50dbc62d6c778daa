#include "model/jacobian/exact.hpp"

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
  visit({Curvature::exact, dx_.slots.adder(df_dx.valuePtr(), 1), dv_.slots.adder(df_dv.valuePtr(), 1)});
}

}  // namespace drape::model
