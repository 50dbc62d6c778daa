#pragma once

#include <cstddef>

#include "model/forces/fused/law.hpp"

/// The loops of FusedForces over columns, vectorised by the compiler.
///
/// They are compiled apart from their caller: if the compiler knew that one argument is the neighbour of another, it would
/// carry values from one column to the next instead of handling eight at once.
namespace drape::model {

constexpr int column_block = 8;  ///< loops run over a multiple of it, so that none needs a remainder

/// Columns from begin to end.
struct Columns {
  int begin, end;
};

/// A vector, in a form that vectorises over columns.
struct Vec {
  double x, y, z;
};

/// A vector for each column, coordinates apart.
struct Field {
  double* data = nullptr;
  std::ptrdiff_t stride = 0;

  Vec operator[](int k) const { return {data[k], data[k + stride], data[k + 2 * stride]}; }
  void set(int k, const Vec& a) const { data[k] = a.x, data[k + stride] = a.y, data[k + 2 * stride] = a.z; }

  Field next() const { return {data + 1, stride}; }    ///< column k + 1 at k
  Field before() const { return {data - 1, stride}; }  ///< column k − 1 at k
};

/// Vectors from one field to another: edges, or their rates.
struct Ends {
  Field begin, end;
};

/// What the edges, cells and particles of a grid that is not uniform have at rest. A column has the weft edge towards the next
/// one, the warp edge from the line before, and the cell between both lines and the next column. cos: <p, q>/(l_p l_q) of the
/// lower or upper edge p and the left or right edge q.
enum ShapeRow {
  weft_width,       ///< [m]
  weft_per_length,  ///< [1/m]
  warp_width,       ///< [m]
  warp_per_length,  ///< [1/m]
  particle_area,    ///< [m²]
  cell_area,        ///< [m²]
  cos_lower_left,
  cos_lower_right,
  cos_upper_left,
  cos_upper_right,
  shape_rows  ///< their number
};

/// The rows of a line.
struct Rows {
  const double* data = nullptr;
  std::ptrdiff_t stride = 0;

  const double* operator[](ShapeRow row) const { return data + row * stride; }
};

/// Edges and their pulls. For contraction also their inverse lengths and the stresses that they cause in the edges across.
struct Edges {
  Field along, pull;
  double *inverse, *stress;
  const double* per_length = nullptr;  ///< 1/l at rest [1/m]; null: the same for all, and in their law
};

/// The edges of cells: lower and upper along u, left and right along v; and the
/// velocities of the corners, v01 above v00. `pull_right`: the pull added to the
/// right edge, stored at the cell, since the next cell adds to the same edge.
struct CellEdges {
  Edges lower, upper, left;
  Field right;
  Field v00, v10, v01, v11;
  const double *right_inverse, *right_stress;
  Field pull_right;

  const double* exists;  ///< 1 where there is a cell, else 0
  Rows shape = {};       ///< none if the grid is uniform
};

/// Splits the coordinates x y z x y z ... of columns into the three arrays of a field.
void part(const double* xyz, Columns columns, const Field& to);

/// The pull of an edge p on its ends: (spring − preload/|p| + dashpot <p, ṗ>/<p, p>) p + drag ṗ.
struct EdgePull {
  double spring, preload, dashpot, drag;

  EdgePull operator*(double width) const { return {width * spring, width * preload, width * dashpot, width * drag}; }
};

/// Sets the edges from their ends, and their pulls times `width`.
void pull_edges(const EdgePull& law, const Ends& x, const Ends& v, const double* width, Columns columns, const Edges& edges);

/// Sets the inverse lengths of edges, and the stresses that they cause in the edges across them. `l`: their rest length, unless
/// each has its own.
void strain_edges(const CellLaw& law, double l, const Ends& v, Columns columns, const Edges& edges);

/// Adds the pulls of cells, and sets those on their right. The law of a uniform grid has been divided by the area of a cell.
void shear_cells(const CellLaw& law, Columns columns, const CellEdges& cells);

/// Adds the pulls of cells with spacings l_u and l_v, unless each has its own.
void contract_cells(double lu, double lv, Columns columns, const CellEdges& cells);

/// Sets the forces f = x y z x y z ... on the particles of a line from the pulls of the edges that they begin and end.
void gather(const Vec& load, const double* width, const Ends& weft, const Ends& warp, const Ends& left_cells, Columns columns,
            double* f);

}  // namespace drape::model
