#pragma once

#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "model/forces/fused/fused_forces.hpp"
#include "model/forces/term.hpp"
#include "model/sheet/normals.hpp"

namespace drape::model {

/// Which part of a force is evaluated.
enum class ForcePart {
  whole,
  explicit_part,  ///< what is not K x + D v
  unconstrained,  ///< what no compliant constraint stands for
  active,         ///< what neither has an energy nor only dissipates
};

/// All forces of one sheet with the memory they need. Only those with nonzero coefficients exist.
class PanelForces {
 public:
  explicit PanelForces(const Sheet& sheet);

  struct NamedTerm {
    std::string_view name;
    Term term;
  };
  const std::vector<NamedTerm>& terms() const { return terms_; }
  bool needs_normals() const { return needs_normals_; }

  /// Sets f (N × 3) [N].
  void evaluate(ForcePart part, double t, const Vectors& x, const Vectors& v, Vectors& f);

  /// Whether a term has anything of the part.
  static bool acts(const Term& term, ForcePart part);

  /// Adds up energies [J], mean forces (SplitOde::mean_excess), blocks of the Jacobian, compliant constraints.
  double energy(const Vectors& x) const;
  void mean_excess(const Vectors& x0, const Vectors& x1, Vectors& f) const;
  void visit(double t, const Vectors& x, const Vectors& v, const JacobianEntries& entries);
  void list_constraints(std::vector<solver::CompliantConstraint>& all) const;

  SparseMatrix stiffness() const { return edge_matrix(law_.edge.spring); }
  SparseMatrix damping() const { return edge_matrix(law_.edge.drag); }

 private:
  const Vectors& normals_of(const Vectors& x);
  SparseMatrix edge_matrix(const WeftWarp& modulus) const;
  const std::unique_ptr<FusedForces>& fused(ForcePart part) const { return fused_[static_cast<std::size_t>(part)]; }

  Grid grid_;
  GridLaw law_;
  std::vector<NamedTerm> terms_;
  std::array<std::unique_ptr<FusedForces>, 4> fused_;  ///< one for each part; null if its law is zero
  Vectors normals_;
  Normals vertex_normals_;
  bool needs_normals_ = false;
};

}  // namespace drape::model
