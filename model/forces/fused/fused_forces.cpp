#include "model/forces/fused/fused_forces.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "model/sheet/metric.hpp"
#include "solver/base/threads.hpp"

namespace drape::model {
namespace {

using solver::Vectors;

/// Columns at a time: this number of two lines fits into a cache of 32 KB. Blocks are short where x, v and f do not stay in a
/// cache, so that the next block is fetched meanwhile: with more than a dozen cache lines in flight the processor waits.
constexpr int long_block = 128, short_block = 32;
constexpr int cached_particles = 20'000;

/// Columns between a block and the one that is fetched meanwhile: memory takes longer to answer than a block takes to compute.
constexpr int fetch_lead = 64;

/// Distance of coordinates where there is no column, so that no edge has the length 0.
constexpr double far = 1e100;

/// Distance of arrays one after the other, such that the same columns of all lie in different sets of a cache. Loops look at
/// the columns before and behind as well.
std::ptrdiff_t row_stride(int length) { return ((length / column_block + 2) | 1) * column_block; }

/// Places arrays one after the other.
class Allocator {
 public:
  Allocator(double* memory, std::ptrdiff_t stride) : next_(memory + column_block), stride_(stride) {}

  double* row() { return std::exchange(next_, next_ + stride_); }
  Field field() { return {std::exchange(next_, next_ + 3 * stride_), stride_}; }

 private:
  double* next_;
  std::ptrdiff_t stride_;
};

/// The same columns one step ahead: edges read the next column, so reads and overwrites of what others read run ahead.
Columns ahead(Columns columns, int end) {
  return {columns.begin == 0 ? 0 : columns.begin + column_block, std::min(columns.end + column_block, end)};
}

/// Prefetches `count` numbers into the cache.
void fetch(const double* data, int count) {
  for (int i = 0; i < count; i += column_block) __builtin_prefetch(data + i);
}

/// The law of the edges in one direction, of rest length l; 1: each has its own.
EdgePull edge_pull(const EdgeLaw& law, double WeftWarp::*direction, double l) {
  return {law.spring.*direction / l, law.preload.*direction, law.dashpot.*direction / l, law.drag.*direction / l};
}

double length_of(const Grid& grid, double spacing) { return grid.uniform() ? spacing : 1; }

Vec scaled(double s, const Eigen::Vector3d& a) { return {s * a[0], s * a[1], s * a[2]}; }

}  // namespace

GridShape::GridShape(const Grid& grid, int length) : rows_(Eigen::ArrayXXd::Zero(row_stride(length), shape_rows * grid.nv)) {
  const auto at = [&](int i, int line, ShapeRow row) -> double& { return rows_(i % grid.nu, shape_rows * line + row); };
  for (const Edge& edge : edges(grid)) {
    const int line = edge.j / grid.nu;
    at(edge.i, line, edge.weft ? weft_width : warp_width) = edge.width;
    at(edge.i, line, edge.weft ? weft_per_length : warp_per_length) = 1 / edge.length;
  }
  const Eigen::VectorXd areas = grid.cell_areas();
  for (int i = 0; i < grid.particles(); ++i) at(i, i / grid.nu, particle_area) = areas[i];
  const Metric metric(grid);
  for (const Cell& cell : cells(grid)) {
    const int i = cell.corner[0][0], line = cell.corner[0][1] / grid.nu;
    const auto cosine = [&](EdgeEnds p, EdgeEnds q) { return metric.product(p, q) / (metric.length(p) * metric.length(q)); };
    at(i, line, cell_area) = metric.area(cell);
    at(i, line, cos_lower_left) = cosine(cell.lower(), cell.left());
    at(i, line, cos_lower_right) = cosine(cell.lower(), cell.right());
    at(i, line, cos_upper_left) = cosine(cell.upper(), cell.left());
    at(i, line, cos_upper_right) = cosine(cell.upper(), cell.right());
  }
}

FusedForces::FusedForces(const Grid& grid, const GridLaw& law)
    : grid_(grid),
      law_(law),
      weft_(edge_pull(law.edge, &WeftWarp::weft, length_of(grid, grid.spacing_u()))),
      warp_(edge_pull(law.edge, &WeftWarp::warp, length_of(grid, grid.spacing_v()))),
      length_((grid.nu + column_block) / column_block * column_block),
      fetches_(grid.particles() > cached_particles),
      weft_width_(Eigen::ArrayXd::Zero(length_)),
      warp_width_(Eigen::ArrayXd::Zero(length_)) {
  if (grid.uniform()) {
    law_.cell.shear /= grid.spacing_u() * grid.spacing_v();
    law_.cell.shear_rate /= grid.spacing_u() * grid.spacing_v();
  } else {
    shape_ = std::make_unique<GridShape>(grid, length_);
  }
  weft_width_.head(grid.nu - 1) = 1;
  for (int a = 0; a < grid.nu; ++a) warp_width_[a] = grid.cell_width_u(a);
}

FusedForces::TwoLines::TwoLines(int length) {
  const std::ptrdiff_t stride = row_stride(length);
  memory.setZero(50 * stride);
  Allocator allocate(memory.data(), stride);
  double distance = 0;
  for (Line& part : line) {
    part.x = allocate.field();
    part.v = allocate.field();
    for (Edges* edges : {&part.weft, &part.warp}) *edges = {allocate.field(), allocate.field(), allocate.row(), allocate.row()};
    part.pull_right = allocate.field();
    for (int k = -column_block; k < length + column_block; ++k) part.x.set(k, {distance += far, 0, 0});
  }
}

void FusedForces::read(int b, Columns columns, const Vectors& from, const Field& to) const {
  part(from.data() + 3 * static_cast<std::ptrdiff_t>(grid_.index(0, b)), ahead(columns, grid_.nu), to);
}

Edges FusedForces::weft_of(int b, const Line& line) const {
  Edges edges = line.weft;
  if (shape_) edges.per_length = shape_->line(b)[weft_per_length];
  return edges;
}

Edges FusedForces::warp_of(int b, const Line& line) const {
  Edges edges = line.warp;
  if (shape_) edges.per_length = shape_->line(b)[warp_per_length];
  return edges;
}

void FusedForces::pull_weft(int b, Columns columns, const Line& line) const {
  const Ends x{line.x, line.x.next()}, v{line.v, line.v.next()};
  const Edges weft = weft_of(b, line);
  if (shape_)
    pull_edges(weft_, x, v, shape_->line(b)[weft_width], columns, weft);
  else
    pull_edges(weft_ * grid_.cell_width_v(b), x, v, weft_width_.data(), columns, weft);
  if (law_.cell.contracts()) strain_edges(law_.cell, grid_.spacing_u(), v, columns, weft);
}

void FusedForces::pull_warp(int b, Columns columns, const Line& before, const Line& line) const {
  const Ends x{before.x, line.x}, v{before.v, line.v};
  const Columns warp = ahead(columns, length_);
  const Edges edges = warp_of(b, line);
  pull_edges(warp_, x, v, shape_ ? shape_->line(b)[warp_width] : warp_width_.data(), warp, edges);
  if (law_.cell.contracts()) strain_edges(law_.cell, grid_.spacing_v(), v, warp, edges);
}

void FusedForces::pull_cells(int b, Columns columns, const Line& before, const Line& line) const {
  const Edges left = warp_of(b, line);
  CellEdges cells{.lower = weft_of(b - 1, before),
                  .upper = weft_of(b, line),
                  .left = left,
                  .right = left.along.next(),
                  .v00 = before.v,
                  .v10 = before.v.next(),
                  .v01 = line.v,
                  .v11 = line.v.next(),
                  .right_inverse = left.inverse + 1,
                  .right_stress = left.stress + 1,
                  .pull_right = line.pull_right,
                  .exists = weft_width_.data()};
  if (shape_) cells.shape = shape_->line(b);
  shear_cells(law_.cell, columns, cells);
  if (law_.cell.contracts()) contract_cells(grid_.spacing_u(), grid_.spacing_v(), columns, cells);
}

void FusedForces::write(int b, Columns columns, const Line& line, const Line& next, Vectors& f) const {
  const Vec load = scaled(shape_ ? 1 : grid_.cell_width_v(b), law_.load);
  gather(load, shape_ ? shape_->line(b)[particle_area] : warp_width_.data(), {line.weft.pull.before(), line.weft.pull},
         {line.warp.pull, next.warp.pull}, {line.pull_right.before(), next.pull_right.before()}, ahead(columns, grid_.nu),
         f.data() + 3 * static_cast<std::ptrdiff_t>(grid_.index(0, b)));
}

void FusedForces::clear_warp(const Line& line) const {
  for (int k = 0; k < length_; ++k) {
    line.warp.pull.set(k, {});
    line.pull_right.set(k, {});
  }
}

void FusedForces::operator()(const Vectors& x, const Vectors& v, Vectors& f) {
  const int threads = base::threads_for_lines(grid_.nv, grid_.particles());
  while (std::ssize(lines_) < threads) lines_.emplace_back(length_);
  base::in_parts(threads, grid_.nv, [&](int k, std::int64_t begin, std::int64_t end) {
    evaluate(static_cast<int>(begin), static_cast<int>(end), lines_[k].line, x, v, f);
  });
}

void FusedForces::evaluate(int begin, int end, const std::array<Line, 2>& lines, const Vectors& x, const Vectors& v,
                           Vectors& f) const {
  const bool velocities = law_.needs_velocities();
  const int first = std::max(begin - 1, 0), read_end = std::min(end + 1, grid_.nv);  // with one line on either side
  clear_warp(lines[first % 2]);
  // Forces of a line are written when the second line after it has been read: then its pulls have arrived in the cache, and
  // they have not been overwritten yet.
  for (int b = first; b < end + 2; ++b) {
    const Line &line = lines[b % 2], &before = lines[1 - b % 2];
    if (b == grid_.nv + 1) clear_warp(before);
    for (Columns columns{0, 0}; columns.end < length_; columns.begin = columns.end) {
      columns.end = std::min(columns.begin + (fetches_ ? short_block : long_block), length_);
      const std::ptrdiff_t next =
          3 * (grid_.index(0, b) + static_cast<std::ptrdiff_t>(columns.end) + column_block + fetch_lead);
      if (b < read_end) read(b, columns, x, line.x);
      if (b < read_end && velocities) read(b, columns, v, line.v);
      if (b >= begin + 2) write(b - 2, columns, line, before, f);
      if (b >= read_end) continue;
      if (fetches_) fetch(x.data() + next, 3 * short_block);
      if (fetches_ && shape_)
        for (int row = 0; row < shape_rows; ++row) fetch(shape_->line(b)[ShapeRow(row)] + columns.end, short_block);
      pull_weft(b, columns, line);
      if (b == first) continue;
      if (fetches_ && velocities) fetch(v.data() + next, 3 * short_block);
      pull_warp(b, columns, before, line);
      if (fetches_ && b >= begin + 2) fetch(f.data() + next - 6 * static_cast<std::ptrdiff_t>(grid_.nu), 3 * short_block);
      if (law_.cell.acts()) pull_cells(b, columns, before, line);
    }
  }
}

}  // namespace drape::model
