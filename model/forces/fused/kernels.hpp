#pragma once

#include <cstddef>

#include "model/forces/fused/law.hpp"

/// The loops of GridSweep over columns, vectorised by the compiler.
///
/// They are compiled apart from their caller on purpose: knowing that one argument is the neighbour of another, the compiler
/// would carry values from one column to the next instead of handling eight at once.
namespace drape::model {

constexpr int lanes = 8;  ///< loops run over a multiple of these, so that none needs a remainder

/// Columns from begin to end.
struct Columns {
  int begin, end;
};

/// A vector, in a form that vectorises: column by column in the lanes.
struct Vec {
  double x, y, z;
};

/// A vector for each column, coordinates apart.
struct Field {
  double* data = nullptr;
  std::ptrdiff_t stride = 0;

  Vec operator[](int k) const { return {data[k], data[k + stride], data[k + 2 * stride]}; }
  void set(int k, const Vec& a) const { data[k] = a.x, data[k + stride] = a.y, data[k + 2 * stride] = a.z; }

  Field next() const { return {data + 1, stride}; }    ///< of the column behind
  Field before() const { return {data - 1, stride}; }  ///< of the column before
};

/// Vectors from one field to another: edges, or their rates.
struct Ends {
  Field begin, end;
};

/// Edges and their pulls. For contraction: their inverse lengths, and what they stress the edges across with.
struct Edges {
  Field along, pull;
  double *inverse, *stress;
};

/// The edges of cells: lower and upper along u, left and right along v; and the
/// velocities of the corners, v01 above v00. `pull_right`: what is added to the
/// right edge, in the place of the cell, since the next cell adds to the same edge.
struct CellEdges {
  Edges lower, upper, left;
  Field right;
  Field v00, v10, v01, v11;
  const double *right_inverse, *right_stress;
  Field pull_right;
};

/// Parts the coordinates x y z x y z ... of columns.
void part(const double* xyz, Columns columns, const Field& to);

/// Finds edges from their ends and sets their pulls; width: what the law is multiplied by.
void pull_edges(const EdgeLaw& law, const Ends& x, const Ends& v, const double* width, Columns columns, const Edges& edges);

/// Sets the inverse lengths of edges of rest length l, and what these edges stress those across them with.
void strain_edges(const CellLaw& law, double l, const Ends& v, Columns columns, const Edges& edges);

/// Adds the pulls of cells, and sets those on their right; exists: 1 for a cell, 0 where there is none.
void shear_cells(const CellLaw& law, const double* exists, Columns columns, const CellEdges& cells);

/// Adds the pulls of cells with spacings l_u and l_v.
void contract_cells(double lu, double lv, const double* exists, Columns columns, const CellEdges& cells);

/// Sets the forces f = x y z x y z ... on the particles of a line from the pulls of the edges that they begin and end.
void gather(const Vec& load, const double* width, const Ends& weft, const Ends& warp, const Ends& left_cells, Columns columns,
            double* f);

}  // namespace drape::model
