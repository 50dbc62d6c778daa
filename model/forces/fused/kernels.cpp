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

template <bool preload, bool dashpot, bool drag, bool own_lengths>
void pull(EdgePull law, Ends x, Ends v, const double* width, Columns columns, Edges edges) {
#pragma GCC ivdep
  for (int k = columns.begin; k < columns.end; ++k) {
    const Vec p = difference(x, k);
    edges.along.set(k, p);
    const double per_length = own_lengths ? edges.per_length[k] : 1;
    double stress = per_length * law.spring;
    if constexpr (preload) stress -= law.preload / std::sqrt(dot(p, p));
    if constexpr (dashpot) stress += per_length * law.dashpot * dot(p, difference(v, k)) / dot(p, p);
    Vec g = stress * p;
    if constexpr (drag) g = g + (per_length * law.drag) * difference(v, k);
    edges.pull.set(k, width[k] * g);
  }
}

template <bool viscous, bool own_lengths>
void strain(CellLaw law, double l, Ends v, Columns columns, Edges edges) {
#pragma GCC ivdep
  for (int k = columns.begin; k < columns.end; ++k) {
    const Vec p = edges.along[k];
    const double pp = dot(p, p), inverse = 1 / std::sqrt(pp);
    const auto over_length = [&](double value) { return own_lengths ? value * edges.per_length[k] : value / l; };
    double stress = law.contraction * (over_length(pp * inverse) - 1);
    if constexpr (viscous) stress += over_length(law.contraction_rate * dot(p, difference(v, k)) * inverse);
    edges.inverse[k] = inverse;
    edges.stress[k] = stress;
  }
}

template <bool viscous, bool own_shape>
void shear(CellLaw law, Columns columns, const CellEdges& cells) {
  const double *area = cells.shape[cell_area], *lower_left = cells.shape[cos_lower_left];
  const double *lower_right = cells.shape[cos_lower_right], *upper_left = cells.shape[cos_upper_left];
  const double* upper_right = cells.shape[cos_upper_right];
  const double* const exists = cells.exists;
  const double *lower_length = cells.lower.per_length, *upper_length = cells.upper.per_length;
  const double* left_length = cells.left.per_length;
  const Field lower = cells.lower.along, upper = cells.upper.along, left = cells.left.along, right = cells.right;
  const Field pull_lower = cells.lower.pull, pull_upper = cells.upper.pull, pull_left = cells.left.pull;
  const Field pull_right = cells.pull_right, v00 = cells.v00, v10 = cells.v10, v01 = cells.v01, v11 = cells.v11;
#pragma GCC ivdep
  for (int k = columns.begin; k < columns.end; ++k) {
    const Vec a = lower[k], b = upper[k], c = left[k], d = right[k];
    // Each quadrant has s = 1/(l_p l_q), and e times s.
    double s_ac = 1, s_ad = 1, s_bc = 1, s_bd = 1;
    double e_ac = dot(a, c), e_ad = dot(a, d), e_bc = dot(b, c), e_bd = dot(b, d);
    if constexpr (own_shape) {
      s_ac = lower_length[k] * left_length[k], s_ad = lower_length[k] * left_length[k + 1];
      s_bc = upper_length[k] * left_length[k], s_bd = upper_length[k] * left_length[k + 1];
      e_ac = s_ac * e_ac - lower_left[k], e_ad = s_ad * e_ad - lower_right[k];
      e_bc = s_bc * e_bc - upper_left[k], e_bd = s_bd * e_bd - upper_right[k];
    }
    double ac = law.shear * e_ac, ad = law.shear * e_ad, bc = law.shear * e_bc, bd = law.shear * e_bd;
    if constexpr (viscous) {
      const Vec va = v10[k] - v00[k], vb = v11[k] - v01[k], vc = v01[k] - v00[k], vd = v11[k] - v10[k];
      ac += s_ac * law.shear_rate * (dot(va, c) + dot(a, vc));
      ad += s_ad * law.shear_rate * (dot(va, d) + dot(a, vd));
      bc += s_bc * law.shear_rate * (dot(vb, c) + dot(b, vc));
      bd += s_bd * law.shear_rate * (dot(vb, d) + dot(b, vd));
    }
    const double weight = own_shape ? area[k] : exists[k];
    ac *= weight * s_ac, ad *= weight * s_ad, bc *= weight * s_bc, bd *= weight * s_bd;
    add(pull_lower, k, ac * c + ad * d);
    add(pull_upper, k, bc * c + bd * d);
    add(pull_left, k, ac * a + bc * b);
    pull_right.set(k, ad * a + bd * b);
  }
}

template <bool own_shape>
void contract(double lu, double lv, Columns columns, CellEdges cells) {
  const double* const exists = cells.exists;
  const double* const area = cells.shape[cell_area];
  const double *lower_length = cells.lower.per_length, *upper_length = cells.upper.per_length;
  const double* left_length = cells.left.per_length;
#pragma GCC ivdep
  for (int k = columns.begin; k < columns.end; ++k) {
    const double weight = own_shape ? area[k] : exists[k];
    double lower = lv, upper = lv, left = lu, right = lu;  // the area over the edge's length
    if constexpr (own_shape) {
      lower = lower_length[k], upper = upper_length[k];
      left = left_length[k], right = left_length[k + 1];
    }
    const double along_u = cells.left.stress[k] + cells.right_stress[k];
    const double along_v = cells.lower.stress[k] + cells.upper.stress[k];
    add(cells.lower.pull, k, weight * lower * along_u * cells.lower.inverse[k] * cells.lower.along[k]);
    add(cells.upper.pull, k, weight * upper * along_u * cells.upper.inverse[k] * cells.upper.along[k]);
    add(cells.left.pull, k, weight * left * along_v * cells.left.inverse[k] * cells.left.along[k]);
    add(cells.pull_right, k, weight * right * along_v * cells.right_inverse[k] * cells.right[k]);
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
      with(law.drag != 0, [&](auto drag) {
        with(edges.per_length != nullptr,
             [&](auto own_lengths) { pull<preload, dashpot, drag, own_lengths>(law, x, v, width, columns, edges); });
      });
    });
  });
}

void strain_edges(const CellLaw& law, double l, const Ends& v, Columns columns, const Edges& edges) {
  with(law.contraction_rate != 0, [&](auto viscous) {
    with(edges.per_length != nullptr, [&](auto own_lengths) { strain<viscous, own_lengths>(law, l, v, columns, edges); });
  });
}

void shear_cells(const CellLaw& law, Columns columns, const CellEdges& cells) {
  with(law.shear_rate != 0, [&](auto viscous) {
    with(cells.shape.data != nullptr, [&](auto own_shape) { shear<viscous, own_shape>(law, columns, cells); });
  });
}

void contract_cells(double lu, double lv, Columns columns, const CellEdges& cells) {
  with(cells.shape.data != nullptr, [&](auto own_shape) { contract<own_shape>(lu, lv, columns, cells); });
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
