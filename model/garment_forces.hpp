#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/garment.hpp"
#include "model/jacobian/exact.hpp"
#include "model/jacobian/newton.hpp"
#include "model/memory/cloth_memory.hpp"
#include "model/panel_forces.hpp"

namespace drape::model {

/// The forces of all panels on the nodes, counted. Panels are swept as grids; where seams join them, positions are gathered and
/// forces added. A single sheet is evaluated in place.
class GarmentForces {
 public:
  GarmentForces(std::shared_ptr<const Garment> garment, solver::Counters& work);

  /// Sets f (nodes × 3) [N] and counts.
  void force(ForcePart part, double t, const Vectors& x, const Vectors& v, Vectors& f);

  /// The same for the energy guard, whose evaluations do not count as work of a method.
  void uncounted_force(ForcePart part, double t, const Vectors& x, const Vectors& v, Vectors& f);

  bool has_constraints() const { return kinds_with(&Kind::constrains); }
  bool has_active() const { return kinds_with(&Kind::active); }
  bool needs_normals() const;
  std::vector<std::string> names() const;  ///< of all forces that some panel has
  std::vector<std::string> without_energy() const;

  /// A force beside those of panels, whose blocks are to be in the Jacobians; the same ones in the same order at each call.
  using VisitForce = std::function<void(double t, const Vectors& x, const Vectors& v, const JacobianEntries& entries)>;
  void also_visit(VisitForce visit) { also_visit_.push_back(std::move(visit)); }

  ClothMemory& memory() { return memory_; }
  double energy(const Vectors& x);
  void mean_excess(const Vectors& x0, const Vectors& x1, Vectors& f);
  std::vector<solver::CompliantConstraint> constraints() const;
  void jacobian(double t, const Vectors& x, const Vectors& v, ExactJacobian& matrix, SparseMatrix& df_dx, SparseMatrix& df_dv);
  void newton_matrix(double t, const Vectors& x, const Vectors& v, double gamma, NewtonMatrix& matrix, SparseMatrix& J);

  SparseMatrix stiffness() const { return sum_of(&PanelForces::stiffness); }
  SparseMatrix damping() const { return sum_of(&PanelForces::damping); }

 private:
  struct Part {
    const Garment::Panel& panel;
    PanelForces forces;
    Vectors x, v, f;  ///< of its particles, if they are not the nodes
  };

  /// A force of the model, for all panels.
  struct Kind {
    std::string_view name;
    std::int64_t* evaluations;
    bool present = false, in_explicit_part = false, in_unconstrained = false;
    bool active = false, constrains = false, without_energy = false;
  };

  /// Together, so that a function that refers to it needs no memory of its own.
  struct Moment {
    double t;
    const Vectors &x, &v;
  };

  /// Whether several threads may visit at the same time: not where normals or a panel's share of nodes are computed.
  bool visits_in_threads() const;
  bool kinds_with(bool Kind::*property) const;
  void visit(const Moment& now, const JacobianEntries& entries);
  SparseMatrix sum_of(SparseMatrix (PanelForces::*matrix)() const) const;

  std::shared_ptr<const Garment> garment_;
  std::vector<Part> parts_;
  std::vector<Kind> kinds_;
  ClothMemory memory_;
  std::vector<VisitForce> also_visit_;
  Vectors x1_;
  std::int64_t &forces_, &explicit_forces_, &jacobians_, &newton_matrices_, &normal_evaluations_;
};

}  // namespace drape::model
