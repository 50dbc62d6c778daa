#include "bench/strips/programs/pfmg.hpp"

#include <HYPRE_struct_ls.h>
#include <mpi.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace drape::bench::strips {
namespace {

using solver::Outcome;
using solver::SparseMatrix;
using solver::Vectors;

constexpr double tolerance = 1e-12;  ///< of the residual over the right side
constexpr int most_iterations = 200;
constexpr int red_black = 2;  ///< HYPRE_StructPFMGSetRelaxType: symmetric, and the same for all shares

/// An object of hypre.
template <class Object, HYPRE_Int (*destroy)(Object)>
struct HypreObject {
  Object object = nullptr;

  HypreObject() = default;
  HypreObject(const HypreObject&) = delete;
  HypreObject& operator=(const HypreObject&) = delete;
  ~HypreObject() { clear(); }
  void clear() {
    if (object != nullptr) destroy(object);
    object = nullptr;
  }
};

/// The star: a particle, and its neighbours along the line and on the lines before and behind.
constexpr std::array<std::array<HYPRE_Int, 2>, 5> star = {{{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
constexpr std::array<HYPRE_Int, 5> star_entries = {0, 1, 2, 3, 4};

class Pfmg : public solver::Preconditioner {
 public:
  explicit Pfmg(const Strip& strip);

  void analyse(const SparseMatrix&) override {}
  Outcome factor(const SparseMatrix& A) override;
  double apply(const Vectors& r, Vectors& z) override;
  bool exact() const override { return true; }
  std::string_view name() const override { return "multigrid"; }
  std::int64_t bytes() const override { return 0; }

 private:
  void make_solver();

  const Strip& strip_;
  std::array<HYPRE_Int, 2> lower_, upper_;  ///< corners of own particles among all: column, line
  std::vector<double> values_;
  HypreObject<HYPRE_StructGrid, HYPRE_StructGridDestroy> grid_;
  HypreObject<HYPRE_StructStencil, HYPRE_StructStencilDestroy> stencil_;
  HypreObject<HYPRE_StructMatrix, HYPRE_StructMatrixDestroy> matrix_;
  HypreObject<HYPRE_StructVector, HYPRE_StructVectorDestroy> right_, solution_;
  HypreObject<HYPRE_StructSolver, HYPRE_StructPFMGDestroy> cycle_;
  HypreObject<HYPRE_StructSolver, HYPRE_StructPCGDestroy> solver_;
  std::int64_t& iterations_;
};

Pfmg::Pfmg(const Strip& strip)
    : strip_(strip),
      lower_{0, strip.share().first},
      upper_{strip.columns() - 1, strip.share().first + strip.share().lines - 1},
      iterations_(
          strip.ode().work->counter("pfmg_iterations", "iterations of hypre's conjugate gradients, of one coordinate")) {
  HYPRE_StructGridCreate(MPI_COMM_WORLD, 2, &grid_.object);
  HYPRE_StructGridSetExtents(grid_.object, lower_.data(), upper_.data());
  HYPRE_StructGridAssemble(grid_.object);
  HYPRE_StructStencilCreate(2, static_cast<HYPRE_Int>(star.size()), &stencil_.object);
  for (const HYPRE_Int entry : star_entries) {
    std::array<HYPRE_Int, 2> offset = star[static_cast<std::size_t>(entry)];
    HYPRE_StructStencilSetElement(stencil_.object, entry, offset.data());
  }
  for (auto* vector : {&right_, &solution_}) {
    HYPRE_StructVectorCreate(MPI_COMM_WORLD, grid_.object, &vector->object);
    HYPRE_StructVectorInitialize(vector->object);
    HYPRE_StructVectorAssemble(vector->object);
  }
}

/// Own rows are complete, since neighbours have copies.
Outcome Pfmg::factor(const SparseMatrix& A) {
  const int columns = strip_.columns();
  const std::array<int, 5> distance = {0, -1, 1, -columns, columns};
  values_.assign(star.size() * static_cast<std::size_t>(strip_.rows()), 0);
  double* row = values_.data();
  for (Eigen::Index i = strip_.first_row(); i < strip_.first_row() + strip_.rows(); ++i, row += star.size())
    for (SparseMatrix::InnerIterator entry(A, static_cast<int>(i)); entry; ++entry)
      for (std::size_t k = 0; k < star.size(); ++k)
        if (entry.col() - entry.row() == distance[k]) row[k] = entry.value();
  matrix_.clear();
  HYPRE_StructMatrixCreate(MPI_COMM_WORLD, grid_.object, stencil_.object, &matrix_.object);
  HYPRE_StructMatrixInitialize(matrix_.object);
  auto entries = star_entries;
  HYPRE_StructMatrixSetBoxValues(matrix_.object, lower_.data(), upper_.data(), static_cast<HYPRE_Int>(star.size()),
                                 entries.data(), values_.data());
  HYPRE_StructMatrixAssemble(matrix_.object);
  make_solver();
  return Outcome::success;
}

void Pfmg::make_solver() {
  solver_.clear();
  cycle_.clear();
  HYPRE_StructPFMGCreate(MPI_COMM_WORLD, &cycle_.object);
  HYPRE_StructPFMGSetMaxIter(cycle_.object, 1);
  HYPRE_StructPFMGSetTol(cycle_.object, 0);
  HYPRE_StructPFMGSetZeroGuess(cycle_.object);
  HYPRE_StructPFMGSetRelaxType(cycle_.object, red_black);
  HYPRE_StructPCGCreate(MPI_COMM_WORLD, &solver_.object);
  HYPRE_StructPCGSetTol(solver_.object, tolerance);
  HYPRE_StructPCGSetMaxIter(solver_.object, most_iterations);
  HYPRE_StructPCGSetTwoNorm(solver_.object, 1);
  HYPRE_StructPCGSetPrecond(solver_.object, HYPRE_StructPFMGSolve, HYPRE_StructPFMGSetup, cycle_.object);
  HYPRE_StructPCGSetup(solver_.object, matrix_.object, right_.object, solution_.object);
}

/// NaN if a system is not solved.
double Pfmg::apply(const Vectors& r, Vectors& z) {
  const auto own = static_cast<std::size_t>(strip_.rows());
  const Eigen::Index first = strip_.first_row();
  values_.resize(own);
  bool solved = true;
  for (int c = 0; c < 3; ++c) {
    Eigen::Map<Eigen::VectorXd> values(values_.data(), strip_.rows());
    values = r.col(c).segment(first, strip_.rows());
    HYPRE_StructVectorSetBoxValues(right_.object, lower_.data(), upper_.data(), values_.data());
    HYPRE_StructVectorSetConstantValues(solution_.object, 0);
    HYPRE_StructPCGSolve(solver_.object, matrix_.object, right_.object, solution_.object);
    HYPRE_Int iterations = 0;
    HYPRE_StructPCGGetNumIterations(solver_.object, &iterations);
    iterations_ += iterations;
    solved = solved && iterations < most_iterations;
    HYPRE_StructVectorGetBoxValues(solution_.object, lower_.data(), upper_.data(), values_.data());
    z.col(c).segment(first, strip_.rows()) = values;
  }
  HYPRE_ClearAllErrors();
  strip_.exchange(z);
  const auto& all = *strip_.ode().partition;
  return solved ? all.sum(all.own(r).dot(all.own(z))) : std::numeric_limits<double>::quiet_NaN();
}

const Strip* solved_strip = nullptr;  // solver::LinearSolver::make has no arguments

}  // namespace

solver::LinearSolver pfmg(const Strip& strip) {
  solved_strip = &strip;
  return {.name = "pfmg", .description = "hypre's conjugate gradients with PFMG", .make = [] {
            return std::unique_ptr<solver::Preconditioner>(std::make_unique<Pfmg>(*solved_strip));
          }};
}

}  // namespace drape::bench::strips
