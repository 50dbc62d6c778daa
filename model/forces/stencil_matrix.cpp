#include "model/forces/stencil_matrix.hpp"

#include <map>

#include "solver/base/threads.hpp"

namespace drape::model {

StencilMatrix::StencilMatrix(const solver::SparseMatrix& matrix) : last_(static_cast<int>(matrix.rows()) - 1), begin_{0} {
  std::map<std::vector<Entry>, int> known;
  std::vector<Entry> row;
  for (int i = 0; i < matrix.outerSize(); ++i) {
    row.clear();
    for (solver::SparseMatrix::InnerIterator entry(matrix, i); entry; ++entry)
      row.push_back({static_cast<int>(entry.col()) - i, entry.value()});
    const auto [stencil, is_new] = known.try_emplace(row, static_cast<int>(known.size()));
    stencil_.push_back(stencil->second);
    if (!is_new) continue;
    entries_.insert(entries_.end(), row.begin(), row.end());
    begin_.push_back(static_cast<int>(entries_.size()));
  }
}

void StencilMatrix::multiply(const solver::Vectors& x, solver::Vectors& y) const {
  base::each_in_parts(base::threads_for(x.rows()), x.rows(),
                      [&](std::int64_t i) { solver::store(y.data() + 3 * i, times(static_cast<int>(i), x)); });
}

}  // namespace drape::model
