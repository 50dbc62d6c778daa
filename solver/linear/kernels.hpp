#pragma once

#include <cstdint>

#include "solver/state.hpp"

namespace drape::solver {

/// The vector kernels of the linear solver. Each passes once over its arguments; none allocates.
///
/// A particle's three coordinates are processed as four lanes; the fourth is the next particle's first coordinate and is
/// ignored: four-wide loads and arithmetic beat three scalar ones by a third (`bench_kernels`).
using Lanes = Eigen::Array4d;

inline auto load(const double* p) { return Lanes::Map(p); }
inline void store(double* p, const Lanes& a) { Eigen::Array3d::Map(p) = a.head<3>(); }
inline double sum(const Lanes& a) { return a[0] + a[1] + a[2]; }

/// y = A x for a scalar N × N matrix; x, y: N × 3. Returns <x, y>.
double multiply(const SparseMatrix& A, const Vectors& x, Vectors& y);

/// x += a p, r −= a q. Returns <r, r>.
double advance(double a, const Vectors& p, const Vectors& q, Vectors& x, Vectors& r);

/// Bytes that `multiply` moves at least: every entry and index once, x read and y written once.
std::int64_t multiply_bytes(const SparseMatrix& A);

/// Bytes of n passes over a vector field of N particles.
constexpr std::int64_t vector_bytes(std::int64_t particles, int passes) { return particles * passes * 3 * sizeof(double); }

}  // namespace drape::solver
