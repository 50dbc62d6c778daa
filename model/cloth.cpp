#include "model/cloth.hpp"

#include <fmt/format.h>

#include "model/exact_jacobian.hpp"
#include "model/grid_sweep.hpp"
#include "model/newton_matrix.hpp"
#include "model/normals.hpp"
#include "model/reaction.hpp"

namespace drape::model {
namespace {

/// A term with the counter of its evaluations.
struct CountedTerm {
  Term term;
  std::int64_t* evaluations;
};

/// The forces of one compiled scene with the memory they need.
class Forces {
 public:
  Forces(const Sheet& sheet, solver::Work& work, Plan& plan);

  void force(double t, const Vectors& x, const Vectors& v, Vectors& f, bool whole);
  double energy(const Vectors& x) const;
  void jacobian(double t, const Vectors& x, const Vectors& v, ExactJacobian& matrix, SparseMatrix& df_dx, SparseMatrix& df_dv);
  void newton_matrix(double t, const Vectors& x, const Vectors& v, double gamma, NewtonMatrix& matrix, SparseMatrix& J);
  SparseMatrix scalar_matrix(std::function<void(std::vector<Eigen::Triplet<double>>&)> Term::*part) const;

 private:
  Configuration configuration(double t, const Vectors& x, const Vectors& v);
  void visit(const Configuration& c, const JacobianEntries& entries) const;

  int particles_;
  std::vector<CountedTerm> terms_;
  std::unique_ptr<GridSweep> whole_law_, explicit_law_;  ///< null if the law is zero
  Vectors normals_;
  Normals vertex_normals_;
  bool needs_normals_ = false;
  std::int64_t &forces_, &explicit_forces_, &jacobians_, &newton_matrices_, &normal_evaluations_;
};

Forces::Forces(const Sheet& sheet, solver::Work& work, Plan& plan)
    : particles_(sheet.grid.particles()),
      vertex_normals_(sheet.grid),
      forces_(work.counter("forces", "evaluations of the whole force")),
      explicit_forces_(work.counter("explicit_forces", "evaluations of the explicit part of the force")),
      jacobians_(work.counter("jacobians", "evaluations of the exact Jacobian")),
      newton_matrices_(work.counter("newton_matrices", "assemblies of the Newton matrix from the exact Jacobian")),
      normal_evaluations_(work.counter("normals", "evaluations of all vertex normals")) {
  GridLaw whole, rest;
  for (const TermKind& kind : term_kinds()) {
    const std::string name(kind.name);
    std::int64_t& evaluations = work.counter("force/" + name, "evaluations of: " + std::string(kind.description));
    std::optional<Term> term = kind.make(sheet);
    if (!term) continue;
    plan.terms.push_back(name);
    needs_normals_ = needs_normals_ || term->needs_normals;
    whole += term->law;
    rest += term->explicit_law;
    terms_.push_back({std::move(*term), &evaluations});
  }
  if (whole.acts()) whole_law_ = std::make_unique<GridSweep>(sheet.grid, whole);
  if (rest.acts()) explicit_law_ = std::make_unique<GridSweep>(sheet.grid, rest);
  if (needs_normals_) normals_.resize(particles_, 3);
  plan.normals = needs_normals_;
}

Configuration Forces::configuration(double t, const Vectors& x, const Vectors& v) {
  if (needs_normals_) {
    vertex_normals_.evaluate(x, normals_);
    ++normal_evaluations_;
  }
  return {t, x, v, normals_};
}

void Forces::force(double t, const Vectors& x, const Vectors& v, Vectors& f, bool whole) {
  ++(whole ? forces_ : explicit_forces_);
  const Configuration c = configuration(t, x, v);
  f.resize(particles_, 3);
  if (const auto& sweep = whole ? whole_law_ : explicit_law_)
    (*sweep)(x, v, f);
  else
    f.setZero();
  for (const auto& [term, evaluations] : terms_) {
    const auto& part = whole ? term.force : term.explicit_force;
    if (part) part(c, f);
    if (part || (whole ? term.law : term.explicit_law).acts()) ++*evaluations;
  }
}

double Forces::energy(const Vectors& x) const {
  double energy = 0;
  for (const auto& [term, evaluations] : terms_)
    if (term.energy) energy += term.energy(x);
  return energy;
}

void Forces::jacobian(double t, const Vectors& x, const Vectors& v, ExactJacobian& matrix, SparseMatrix& df_dx,
                      SparseMatrix& df_dv) {
  ++jacobians_;
  const Configuration c = configuration(t, x, v);
  matrix.assemble([&](const JacobianEntries& entries) { visit(c, entries); }, df_dx, df_dv);
}

void Forces::visit(const Configuration& c, const JacobianEntries& entries) const {
  for (const auto& [term, evaluations] : terms_)
    if (term.jacobian) term.jacobian(c, entries);
}

void Forces::newton_matrix(double t, const Vectors& x, const Vectors& v, double gamma, NewtonMatrix& matrix, SparseMatrix& J) {
  ++newton_matrices_;
  const Configuration c = configuration(t, x, v);
  matrix.assemble([&](const JacobianEntries& entries) { visit(c, entries); }, gamma, J);
}

SparseMatrix Forces::scalar_matrix(std::function<void(std::vector<Eigen::Triplet<double>>&)> Term::*part) const {
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [term, evaluations] : terms_)
    if (term.*part) (term.*part)(entries);
  SparseMatrix matrix(particles_, particles_);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Eigen::VectorXd masses(const Sheet& sheet) {
  Eigen::VectorXd mass(sheet.grid.particles());
  for (int b = 0; b < sheet.grid.nv; ++b)
    for (int a = 0; a < sheet.grid.nu; ++a) mass[sheet.grid.index(a, b)] = sheet.material.density * sheet.grid.cell_area(a, b);
  return mass;
}

int count_fixed(const std::vector<solver::Pin>& pins) {
  int count = 0;
  for (const solver::Pin& pin : pins) count += pin.fixed[0] + pin.fixed[1] + pin.fixed[2];
  return count;
}

/// Lets the obstacles act, by constraints in the solver or by forces.
void respond(const ContactRule& rule, const std::shared_ptr<Contacts>& contacts, solver::SplitOde& ode) {
  if (rule.response == ResponseKind::constraint) {
    ode.contacts = [contacts](double t, double h, const solver::State& y, std::vector<solver::Contact>& found) {
      contacts->find(t, h, y, found);
    };
    return;
  }
  const auto reaction = std::make_shared<Reaction>(contacts, rule, ode.mass);
  const auto whole = std::make_shared<Vectors>(ode.particles(), 3);
  const auto force = ode.force;
  ode.force = [=](double t, const Vectors& x, const Vectors& v, Vectors& f) {
    force(t, x, v, f);
    if (reaction->acts(t, x)) reaction->add(v, f, f);
  };
  ode.explicit_force = [=, rest = ode.explicit_force](double t, const Vectors& x, const Vectors& v, Vectors& f) {
    rest(t, x, v, f);
    if (!reaction->acts(t, x)) return;
    force(t, x, v, *whole);
    reaction->add(v, *whole, f);
  };
}

}  // namespace

Cloth compile(const Scene& scene) {
  Cloth cloth;
  solver::SplitOde& ode = cloth.ode;
  const auto forces = std::make_shared<Forces>(scene.sheet, *ode.work, cloth.plan);
  ode.mass = masses(scene.sheet);
  ode.pins = pins(scene);
  ode.stiffness = forces->scalar_matrix(&Term::stiffness);
  ode.damping = forces->scalar_matrix(&Term::damping);
  ode.force = [forces](double t, const Vectors& x, const Vectors& v, Vectors& f) { forces->force(t, x, v, f, true); };
  ode.explicit_force = [forces](double t, const Vectors& x, const Vectors& v, Vectors& f) { forces->force(t, x, v, f, false); };
  ode.potential_energy = [forces](double, const Vectors& x) { return forces->energy(x); };
  ode.jacobian = [forces, exact = ExactJacobian(3 * ode.particles())](double t, const Vectors& x, const Vectors& v,
                                                                      SparseMatrix& df_dx, SparseMatrix& df_dv) mutable {
    forces->jacobian(t, x, v, exact, df_dx, df_dv);
  };
  ode.newton_matrix = [forces, lean = NewtonMatrix(Curvature::lean, ode.mass, ode.pins),
                       convex = NewtonMatrix(Curvature::convex, ode.mass, ode.pins)](
                          double t, const Vectors& x, const Vectors& v, double gamma, bool is_lean, SparseMatrix& J) mutable {
    forces->newton_matrix(t, x, v, gamma, is_lean ? lean : convex, J);
  };
  if (!scene.obstacles.empty()) {
    cloth.contacts = std::make_shared<Contacts>(scene, *ode.work);
    respond(scene.contact, cloth.contacts, ode);
  }
  cloth.start = start(scene);
  solver::prescribe(ode.pins, cloth.start.v);
  cloth.plan.obstacles = static_cast<int>(scene.obstacles.size());
  cloth.plan.particles = ode.particles();
  cloth.plan.pinned_dofs = count_fixed(ode.pins);
  cloth.plan.stiffness_entries = static_cast<int>(ode.stiffness.nonZeros());
  cloth.plan.damping_entries = static_cast<int>(ode.damping.nonZeros());
  return cloth;
}

std::string to_string(const Plan& plan) {
  return fmt::format(
      "{} particles, {} of {} degrees of freedom pinned; forces: {}; normals: {}; obstacles: {}; entries of K: {}, of D: {}",
      plan.particles, plan.pinned_dofs, 3 * plan.particles,
      plan.terms.empty() ? "none" : fmt::format("{}", fmt::join(plan.terms, ", ")), plan.normals ? "yes" : "no", plan.obstacles,
      plan.stiffness_entries, plan.damping_entries);
}

}  // namespace drape::model
