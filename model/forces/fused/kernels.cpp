#include "model/forces/fused/kernels.hpp"

#include <cmath>
#include <type_traits>

namespace drape::model {
namespace {

Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator-(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec operator*(double s, const Vec& a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Vec difference(const Ends& ends, int k) { return ends.end[k] - ends.begin[k]; }
void add(const Field& sum, int k, const Vec& a) { sum.set(k, sum[k] + a); }

// The templates take laws and fields by value, so that no store of a loop can change them.

/// Calls f with the condition as a constant, so that unneeded branches are not compiled.
template <class F>
void with(bool condition, const F& f) {
  condition ? f(std::true_type()) : f(std::false_type());
}

template <bool preload, bool dashpot, bool drag>
void pull(EdgePull law, Ends x, Ends v, const double* width, Columns columns, Edges edges) {
#pragma GCC ivdep
  for (int k = columns.begin; k < columns.end; ++k) {
    const Vec p = difference(x, k);
    edges.along.set(k, p);
    double stress = law.spring;
    if constexpr (preload) stress -= law.preload / std::sqrt(dot(p, p));
    if constexpr (dashpot) stress += law.dashpot * dot(p, difference(v, k)) / dot(p, p);
    Vec g = stress * p;
    if constexpr (drag) g = g + law.drag * difference(v, k);
    edges.pull.set(k, width[k] * g);
  }
}

template <bool viscous>
void strain(CellLaw law, double l, Ends v, Columns columns, Edges edges) {
#pragma GCC ivdep
  for (int k = columns.begin; k < columns.end; ++k) {
    const Vec p = edges.along[k];
    const double pp = dot(p, p), inverse = 1 / std::sqrt(pp);
    double stress = law.contraction * (pp * inverse / l - 1);
    if constexpr (viscous) stress += law.contraction_rate * dot(p, difference(v, k)) * inverse / l;
    edges.inverse[k] = inverse;
    edges.stress[k] = stress;
  }
}

template <bool viscous>
void shear(CellLaw law, const double* exists, Columns columns, const CellEdges& cells) {
  const Field lower = cells.lower.along, upper = cells.upper.along, left = cells.left.along, right = cells.right;
  const Field pull_lower = cells.lower.pull, pull_upper = cells.upper.pull, pull_left = cells.left.pull;
  const Field pull_right = cells.pull_right, v00 = cells.v00, v10 = cells.v10, v01 = cells.v01, v11 = cells.v11;
#pragma GCC ivdep
  for (int k = columns.begin; k < columns.end; ++k) {
    const Vec a = lower[k], b = upper[k], c = left[k], d = right[k];
    double ac = law.shear * dot(a, c), ad = law.shear * dot(a, d);
    double bc = law.shear * dot(b, c), bd = law.shear * dot(b, d);
    if constexpr (viscous) {
      const Vec va = v10[k] - v00[k], vb = v11[k] - v01[k], vc = v01[k] - v00[k], vd = v11[k] - v10[k];
      ac += law.shear_rate * (dot(va, c) + dot(a, vc));
      ad += law.shear_rate * (dot(va, d) + dot(a, vd));
      bc += law.shear_rate * (dot(vb, c) + dot(b, vc));
      bd += law.shear_rate * (dot(vb, d) + dot(b, vd));
    }
    ac *= exists[k], ad *= exists[k], bc *= exists[k], bd *= exists[k];
    add(pull_lower, k, ac * c + ad * d);
    add(pull_upper, k, bc * c + bd * d);
    add(pull_left, k, ac * a + bc * b);
    pull_right.set(k, ad * a + bd * b);
  }
}

}  // namespace

void part(const double* xyz, Columns columns, const Field& to) {
  const Field field = to;
#pragma GCC ivdep
  for (int k = columns.begin; k < columns.end; ++k) field.set(k, {xyz[3 * k], xyz[3 * k + 1], xyz[3 * k + 2]});
}

void pull_edges(const EdgePull& law, const Ends& x, const Ends& v, const double* width, Columns columns, const Edges& edges) {
  with(law.preload != 0, [&](auto preload) {
    with(law.dashpot != 0, [&](auto dashpot) {
      with(law.drag != 0, [&](auto drag) { pull<preload, dashpot, drag>(law, x, v, width, columns, edges); });
    });
  });
}

void strain_edges(const CellLaw& law, double l, const Ends& v, Columns columns, const Edges& edges) {
  with(law.contraction_rate != 0, [&](auto viscous) { strain<viscous>(law, l, v, columns, edges); });
}

void shear_cells(const CellLaw& law, const double* exists, Columns columns, const CellEdges& cells) {
  with(law.shear_rate != 0, [&](auto viscous) { shear<viscous>(law, exists, columns, cells); });
}

void contract_cells(double lu, double lv, const double* exists, Columns columns, const CellEdges& all) {
  const CellEdges cells = all;
#pragma GCC ivdep
  for (int k = columns.begin; k < columns.end; ++k) {
    const double along_u = exists[k] * lv * (cells.left.stress[k] + cells.right_stress[k]);
    const double along_v = exists[k] * lu * (cells.lower.stress[k] + cells.upper.stress[k]);
    add(cells.lower.pull, k, along_u * cells.lower.inverse[k] * cells.lower.along[k]);
    add(cells.upper.pull, k, along_u * cells.upper.inverse[k] * cells.upper.along[k]);
    add(cells.left.pull, k, along_v * cells.left.inverse[k] * cells.left.along[k]);
    add(cells.pull_right, k, along_v * cells.right_inverse[k] * cells.right[k]);
  }
}

void gather(const Vec& load, const double* width, const Ends& weft_pulls, const Ends& warp_pulls, const Ends& left_cells,
            Columns columns, double* f) {
  const Ends weft = weft_pulls, warp = warp_pulls, left = left_cells;
  const Vec weight = load;
#pragma GCC ivdep
  for (int k = columns.begin; k < columns.end; ++k) {
    const Vec force = width[k] * weight + difference(weft, k) + difference(warp, k) + difference(left, k);
    f[3 * k] = force.x;
    f[3 * k + 1] = force.y;
    f[3 * k + 2] = force.z;
  }
}

}  // namespace drape::model
