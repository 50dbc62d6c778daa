#include "model/jacobian/newton.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <utility>

#include "solver/base/threads.hpp"

namespace drape::model {
namespace {

/// Each block once: on large sheets duplicates would take many times the memory of the matrix.
Blocks distinct(Blocks blocks, const Blocks& more) {
  blocks.insert(blocks.end(), more.begin(), more.end());
  const auto before = [](const Eigen::Vector2i& a, const Eigen::Vector2i& b) {
    return std::pair(a[0], a[1]) < std::pair(b[0], b[1]);
  };
  std::ranges::sort(blocks, before);
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  return blocks;
}

}  // namespace

NewtonMatrix::NewtonMatrix(Curvature curvature, const Eigen::VectorXd& mass, const std::vector<solver::Pin>& pins)
    : curvature_(curvature), mass_(solver::thrice(mass)), pinned_(mass_.size(), false), oblique_(pins) {
  for (const solver::Pin& pin : pins)
    for (int a = 0; a < 3; ++a) pinned_[3 * pin.particle + a] = pin.fixed(a);
}

void NewtonMatrix::analyse(const VisitBlocks& visit) {
  Blocks dx, dv;
  visit({curvature_, recorder(dx), recorder(dv)});
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < mass_.size(); ++i) entries.emplace_back(i, i, 1);
  for (const Eigen::Vector2i& block : distinct(dx, dv))
    for_entries(block[0], block[1], [&](int row, int column, int) {
      if (kept(row, column)) entries.emplace_back(row, column, 1);
    });
  pattern_.resize(mass_.size(), mass_.size());
  pattern_.setFromTriplets(entries.begin(), entries.end());
  diagonal_.assign(pattern_.outerIndexPtr(), pattern_.outerIndexPtr() + mass_.size());  // the first of each row
  const auto is_kept = [this](int row, int column) { return kept(row, column); };
  dx_.find(dx, pattern_, is_kept);
  dv_.find(dv, pattern_, is_kept);
}

void NewtonMatrix::assemble(const VisitBlocks& visit, bool in_threads, double gamma, SparseMatrix& J) {
  constexpr int as_particles = 20;  // blocks of a particle take that many times as long as its forces
  if (pattern_.size() == 0) analyse(visit);
  if (J.nonZeros() != pattern_.nonZeros()) J = pattern_;
  double* const values = J.valuePtr();
  std::fill_n(values, J.nonZeros(), 0.0);
  for (int i = 0; i < mass_.size(); ++i) values[diagonal_[i]] = mass_[i];
  const std::int64_t particles = mass_.size() / 3;
  base::in_parts(in_threads ? base::threads_for(as_particles * particles) : 1, particles,
                 [&](int, std::int64_t begin, std::int64_t end) {
                   add_rows(visit, gamma, static_cast<int>(begin), static_cast<int>(end), values);
                 });
}

void NewtonMatrix::add_rows(const VisitBlocks& visit, double gamma, int begin, int end, double* values) const {
  BlockSlots::Adder add_dx(dx_, values, -gamma * gamma, begin, end), add_dv(dv_, values, -gamma, begin, end);
  const auto skip = [&](int dx, int dv) {
    add_dx.skip(dx);
    add_dv.skip(dv);
  };
  if (oblique_.empty()) return visit({curvature_, std::ref(add_dx), std::ref(add_dv), begin, end, std::ref(skip)});
  const auto add_filtered = [this](BlockSlots::Adder& add) {
    return [this, &add](int i, int j, const Eigen::Matrix3d& block) { add(i, j, oblique_.filtered(i, j, block)); };
  };
  visit({curvature_, add_filtered(add_dx), add_filtered(add_dv), begin, end, std::ref(skip)});
}

}  // namespace drape::model
