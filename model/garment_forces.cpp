#include "model/garment_forces.hpp"

#include <algorithm>
#include <utility>

#include "model/panel_memory.hpp"

namespace drape::model {

GarmentForces::GarmentForces(std::shared_ptr<const Garment> garment, solver::Counters& work)
    : garment_(std::move(garment)),
      memory_(work),
      forces_(work.counter("forces", "evaluations of the whole force")),
      explicit_forces_(work.counter("explicit_forces", "evaluations of the explicit part of the force")),
      jacobians_(work.counter("jacobians", "evaluations of the exact Jacobian")),
      newton_matrices_(work.counter("newton_matrices", "assemblies of the Newton matrix from the exact Jacobian")),
      normal_evaluations_(work.counter("normals", "evaluations of all vertex normals")) {
  for (const TermKind& kind : term_kinds_of(garment_->panels().front().sheet)) {  // panels have the same forces added
    const std::string name(kind.name);
    kinds_.push_back({kind.name, &work.counter("force/" + name, "evaluations of: " + std::string(kind.description))});
  }
  for (const Garment::Panel& panel : garment_->panels()) {
    parts_.push_back({panel, PanelForces(panel.sheet), {}, {}, {}});
    for (const auto& [name, term] : parts_.back().forces.terms()) {
      Kind& kind = *std::ranges::find(kinds_, name, &Kind::name);
      kind.present = true;
      kind.in_explicit_part = kind.in_explicit_part || PanelForces::acts(term, ForcePart::explicit_part);
      kind.in_unconstrained = kind.in_unconstrained || PanelForces::acts(term, ForcePart::unconstrained);
      kind.active = kind.active || PanelForces::acts(term, ForcePart::active);
      kind.constrains = kind.constrains || term.list_constraints;
      kind.without_energy = kind.without_energy || term.without_energy;
      if (term.memory) memory_.add(of_nodes(term.memory, panel));
    }
  }
}

bool GarmentForces::kinds_with(bool Kind::*property) const {
  return std::ranges::any_of(kinds_, [&](const Kind& kind) { return kind.*property; });
}

bool GarmentForces::needs_normals() const {
  return std::ranges::any_of(parts_, [](const Part& part) { return part.forces.needs_normals(); });
}

bool GarmentForces::visits_in_threads() const {
  const Part& first = parts_.front();
  return also_visit_.empty() && first.panel.nodes.empty() && !needs_normals() &&
         std::ranges::all_of(first.forces.terms(), [](const PanelForces::NamedTerm& named) {
           return !named.term.jacobian || named.term.jacobian_in_threads;
         });
}

std::vector<std::string> GarmentForces::names() const {
  std::vector<std::string> all;
  for (const Kind& kind : kinds_)
    if (kind.present) all.emplace_back(kind.name);
  return all;
}

std::vector<std::string> GarmentForces::without_energy() const {
  std::vector<std::string> all;
  for (const Kind& kind : kinds_)
    if (kind.without_energy) all.emplace_back(kind.name);
  return all;
}

void GarmentForces::uncounted_force(ForcePart which, double t, const Vectors& x, const Vectors& v, Vectors& f) {
  if (Part& part = parts_.front(); part.panel.nodes.empty()) return part.forces.evaluate(which, t, x, v, f);
  f.setZero(garment_->nodes(), 3);
  for (Part& part : parts_) {
    part.forces.evaluate(which, t, part.panel.seen(x, part.x), part.panel.seen(v, part.v), part.f);
    part.panel.add(part.f, f);
  }
}

/// What is unconstrained counts as explicit, which it is to methods that need it.
void GarmentForces::force(ForcePart which, double t, const Vectors& x, const Vectors& v, Vectors& f) {
  ++(which == ForcePart::whole ? forces_ : explicit_forces_);
  normal_evaluations_ += needs_normals();
  uncounted_force(which, t, x, v, f);
  for (const Kind& kind : kinds_) {
    const bool part = which == ForcePart::explicit_part ? kind.in_explicit_part : kind.in_unconstrained;
    *kind.evaluations += which == ForcePart::whole ? kind.present : part;
  }
}

double GarmentForces::energy(const Vectors& x) {
  double energy = 0;
  for (Part& part : parts_) energy += part.forces.energy(part.panel.seen(x, part.x));
  return energy;
}

void GarmentForces::mean_excess(const Vectors& x0, const Vectors& x1, Vectors& f) {
  if (Part& part = parts_.front(); part.panel.nodes.empty()) return part.forces.mean_excess(x0, x1, f);
  for (Part& part : parts_) {
    part.f.setZero(part.panel.sheet.grid.particles(), 3);
    part.forces.mean_excess(part.panel.seen(x0, part.x), part.panel.seen(x1, x1_), part.f);
    part.panel.add(part.f, f);
  }
}

std::vector<solver::CompliantConstraint> GarmentForces::constraints() const {
  std::vector<solver::CompliantConstraint> all;
  for (const Part& part : parts_) {
    const std::size_t before = all.size();
    part.forces.list_constraints(all);
    for (std::size_t k = before; k < all.size(); ++k)
      for (int& particle : all[k].particles) particle = part.panel.node(particle);
  }
  return all;
}

void GarmentForces::visit(const Moment& now, const JacobianEntries& entries) {
  const auto& [t, x, v] = now;
  for (const VisitForce& also : also_visit_) also(t, x, v, entries);
  if (Part& part = parts_.front(); part.panel.nodes.empty()) return part.forces.visit(t, x, v, entries);
  for (Part& part : parts_) {
    const auto by_nodes = [&panel = part.panel](const JacobianEntries::Add& add) {
      return [&](int i, int j, const Eigen::Matrix3d& block) { add(panel.node(i), panel.node(j), block); };
    };
    part.forces.visit(t, part.panel.seen(x, part.x), part.panel.seen(v, part.v),
                      {entries.curvature, by_nodes(entries.add_dx), by_nodes(entries.add_dv)});
  }
}

void GarmentForces::jacobian(double t, const Vectors& x, const Vectors& v, ExactJacobian& matrix, SparseMatrix& df_dx,
                             SparseMatrix& df_dv) {
  ++jacobians_;
  normal_evaluations_ += needs_normals();
  const Moment now{t, x, v};
  matrix.assemble([this, &now](const JacobianEntries& entries) { visit(now, entries); }, df_dx, df_dv);
}

void GarmentForces::newton_matrix(double t, const Vectors& x, const Vectors& v, double gamma, NewtonMatrix& matrix,
                                  SparseMatrix& J) {
  ++newton_matrices_;
  normal_evaluations_ += needs_normals();
  const Moment now{t, x, v};
  matrix.assemble([this, &now](const JacobianEntries& entries) { visit(now, entries); }, visits_in_threads(), gamma, J);
}

SparseMatrix GarmentForces::sum_of(SparseMatrix (PanelForces::*matrix)() const) const {
  if (parts_.front().panel.nodes.empty()) return (parts_.front().forces.*matrix)();
  std::vector<Eigen::Triplet<double>> entries;
  for (const Part& part : parts_) {
    const SparseMatrix own = (part.forces.*matrix)();
    for (int i = 0; i < own.rows(); ++i)
      for (SparseMatrix::InnerIterator entry(own, i); entry; ++entry)
        entries.emplace_back(part.panel.node(i), part.panel.node(static_cast<int>(entry.col())), entry.value());
  }
  SparseMatrix sum(garment_->nodes(), garment_->nodes());
  sum.setFromTriplets(entries.begin(), entries.end());
  return sum;
}

}  // namespace drape::model
