#include "model/panel_forces.hpp"

#include "model/sheet/edges.hpp"

namespace drape::model {

PanelForces::PanelForces(const Sheet& sheet) : grid_(sheet.grid), vertex_normals_(sheet.grid) {
  GridLaw active, unconstrained;
  bool constrained = false;
  for (const TermKind& kind : term_kinds_of(sheet)) {
    std::optional<Term> term = make_term(kind, sheet);
    if (!term) continue;
    needs_normals_ = needs_normals_ || term->needs_normals;
    constrained = constrained || term->list_constraints;
    law_ += term->law;
    active += term->active_law;
    unconstrained += term->law_without_constraints();
    terms_.push_back({kind.name, std::move(*term)});
  }
  const auto fuse = [&](ForcePart part, const GridLaw& law) {
    if (law.acts()) fused_[static_cast<std::size_t>(part)] = std::make_unique<FusedForces>(grid_, law);
  };
  fuse(ForcePart::whole, law_);
  fuse(ForcePart::explicit_part, law_.explicit_part());
  fuse(ForcePart::active, active);
  if (constrained) fuse(ForcePart::unconstrained, unconstrained);
  if (needs_normals_) normals_.resize(grid_.particles(), 3);
}

const Vectors& PanelForces::normals_of(const Vectors& x) {
  if (needs_normals_) vertex_normals_.evaluate(x, normals_);
  return normals_;
}

void PanelForces::evaluate(ForcePart part, double t, const Vectors& x, const Vectors& v, Vectors& f) {
  const Configuration c{t, x, v, normals_of(x)};
  f.resize(grid_.particles(), 3);
  if (const auto& law = fused(part))
    (*law)(x, v, f);
  else
    f.setZero();
  for (const auto& [name, term] : terms_)
    if (term.force && (part != ForcePart::active || term.active)) term.force(c, f);
  if (part == ForcePart::whole || part == ForcePart::unconstrained)
    for (const auto& [name, term] : terms_)
      if (term.springs) term.springs(x, f);
}

bool PanelForces::acts(const Term& term, ForcePart part) {
  switch (part) {
    case ForcePart::whole: return true;
    case ForcePart::explicit_part: return term.force || term.law.explicit_part().acts();
    case ForcePart::unconstrained: return term.force || term.law_without_constraints().acts();
    case ForcePart::active: break;
  }
  return term.active || term.active_law.acts();
}

double PanelForces::energy(const Vectors& x) const {
  double energy = 0;
  for (const auto& [name, term] : terms_)
    if (term.energy) energy += term.energy(x);
  return energy;
}

void PanelForces::mean_excess(const Vectors& x0, const Vectors& x1, Vectors& f) const {
  for (const auto& [name, term] : terms_)
    if (term.mean_excess) term.mean_excess(x0, x1, f);
}

void PanelForces::visit(double t, const Vectors& x, const Vectors& v, const JacobianEntries& entries) {
  const Configuration c{t, x, v, normals_of(x)};
  for (const auto& [name, term] : terms_)
    if (term.jacobian) term.jacobian(c, entries);
}

void PanelForces::list_constraints(std::vector<solver::CompliantConstraint>& all) const {
  for (const auto& [name, term] : terms_)
    if (term.list_constraints) term.list_constraints(all);
}

SparseMatrix PanelForces::edge_matrix(const WeftWarp& modulus) const {
  return spring_matrix(grid_, [&](const Edge& edge) { return along(modulus, edge) * edge.width / edge.length; });
}

}  // namespace drape::model
