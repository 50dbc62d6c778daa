#include "model/cloth.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/forces/fused/fused_forces.hpp"
#include "model/jacobian/exact.hpp"
#include "model/jacobian/newton.hpp"
#include "model/memory/cloth_memory.hpp"
#include "model/obstacles/reaction.hpp"
#include "model/sheet/edges.hpp"
#include "model/sheet/normals.hpp"

namespace drape::model {
namespace {

struct CountedTerm {
  Term term;
  bool in_explicit_force;       ///< whether K x + D v is not all of it
  bool in_unconstrained_force;  ///< whether compliant constraints do not stand for all of it
  std::int64_t* evaluations;
};

/// The forces of one compiled scene with the memory they need.
class Forces {
 public:
  Forces(const Sheet& sheet, solver::Counters& work, Plan& plan);

  /// Sets f and counts.
  void force(double t, const Vectors& x, const Vectors& v, Vectors& f, bool whole);
  void unconstrained_force(double t, const Vectors& x, const Vectors& v, Vectors& f);

  bool has_constraints() const;
  std::vector<solver::CompliantConstraint> constraints() const;

  /// For the energy guard, whose evaluations do not count as work of a method: sets f, uncounted.
  void whole(double t, const Vectors& x, const Vectors& v, Vectors& f) {
    add_up(whole_law_, {t, x, v, normals_of(x)}, f);
    add_springs(x, f);
  }
  void active(double t, const Vectors& x, const Vectors& v, Vectors& f) {
    add_up(active_law_, {t, x, v, normals_of(x)}, f, &Term::active);
  }
  bool has_active() const;

  ClothMemory& memory() { return memory_; }
  double energy(const Vectors& x) const;
  void mean_excess(const Vectors& x0, const Vectors& x1, Vectors& f) const;
  void jacobian(double t, const Vectors& x, const Vectors& v, ExactJacobian& matrix, SparseMatrix& df_dx, SparseMatrix& df_dv);
  void newton_matrix(double t, const Vectors& x, const Vectors& v, double gamma, NewtonMatrix& matrix, SparseMatrix& J);

  SparseMatrix stiffness() const { return edge_matrix(law_.edge.spring); }
  SparseMatrix damping() const { return edge_matrix(law_.edge.drag); }

 private:
  const Vectors& normals_of(const Vectors& x);
  Configuration configuration(double t, const Vectors& x, const Vectors& v);
  SparseMatrix edge_matrix(const WeftWarp& modulus) const;
  void add_up(const std::unique_ptr<FusedForces>& law, const Configuration& c, Vectors& f, bool Term::*which = nullptr) const;
  void add_springs(const Vectors& x, Vectors& f) const;
  void visit(const Configuration& c, const JacobianEntries& entries) const;

  Grid grid_;
  ClothMemory memory_;
  GridLaw law_;
  std::vector<CountedTerm> terms_;
  std::unique_ptr<FusedForces> whole_law_, explicit_law_, unconstrained_law_, active_law_;  ///< null if the law is zero
  Vectors normals_;
  Normals vertex_normals_;
  bool needs_normals_ = false;
  std::int64_t &forces_, &explicit_forces_, &jacobians_, &newton_matrices_, &normal_evaluations_;
};

Forces::Forces(const Sheet& sheet, solver::Counters& work, Plan& plan)
    : grid_(sheet.grid),
      memory_(work),
      vertex_normals_(sheet.grid),
      forces_(work.counter("forces", "evaluations of the whole force")),
      explicit_forces_(work.counter("explicit_forces", "evaluations of the explicit part of the force")),
      jacobians_(work.counter("jacobians", "evaluations of the exact Jacobian")),
      newton_matrices_(work.counter("newton_matrices", "assemblies of the Newton matrix from the exact Jacobian")),
      normal_evaluations_(work.counter("normals", "evaluations of all vertex normals")) {
  GridLaw active, unconstrained;
  for (const TermKind& kind : term_kinds()) {
    const std::string name(kind.name);
    std::int64_t& evaluations = work.counter("force/" + name, "evaluations of: " + std::string(kind.description));
    std::optional<Term> term = kind.make(sheet);
    if (!term) continue;
    plan.terms.push_back(name);
    if (term->without_energy) plan.without_energy.push_back(name);
    needs_normals_ = needs_normals_ || term->needs_normals;
    law_ += term->law;
    active += term->active_law;
    unconstrained += term->law_without_constraints();
    const bool in_explicit_force = term->force || term->law.explicit_part().acts();
    const bool unconstrained_acts = term->force || term->law_without_constraints().acts();
    terms_.push_back({std::move(*term), in_explicit_force, unconstrained_acts, &evaluations});
  }
  const auto fused = [&](const GridLaw& law) { return law.acts() ? std::make_unique<FusedForces>(grid_, law) : nullptr; };
  whole_law_ = fused(law_);
  explicit_law_ = fused(law_.explicit_part());
  active_law_ = fused(active);
  if (has_constraints()) unconstrained_law_ = fused(unconstrained);
  for (const CountedTerm& counted : terms_)
    if (counted.term.memory) memory_.add(counted.term.memory);
  if (needs_normals_) normals_.resize(grid_.particles(), 3);
  plan.normals = needs_normals_;
  plan.internal_variables = memory_.variables();
}

const Vectors& Forces::normals_of(const Vectors& x) {
  if (needs_normals_) vertex_normals_.evaluate(x, normals_);
  return normals_;
}

Configuration Forces::configuration(double t, const Vectors& x, const Vectors& v) {
  normal_evaluations_ += needs_normals_;
  return {t, x, v, normals_of(x)};
}

/// Sets f to the law's forces and the terms' own, of all terms or of those with `which`.
void Forces::add_up(const std::unique_ptr<FusedForces>& law, const Configuration& c, Vectors& f, bool Term::*which) const {
  f.resize(grid_.particles(), 3);
  if (law)
    (*law)(c.x, c.v, f);
  else
    f.setZero();
  for (const CountedTerm& counted : terms_)
    if (counted.term.force && (which == nullptr || counted.term.*which)) counted.term.force(c, f);
}

void Forces::add_springs(const Vectors& x, Vectors& f) const {
  for (const CountedTerm& counted : terms_)
    if (counted.term.springs) counted.term.springs(x, f);
}

void Forces::force(double t, const Vectors& x, const Vectors& v, Vectors& f, bool whole) {
  ++(whole ? forces_ : explicit_forces_);
  add_up(whole ? whole_law_ : explicit_law_, configuration(t, x, v), f);
  if (whole) add_springs(x, f);
  for (const CountedTerm& counted : terms_) *counted.evaluations += whole || counted.in_explicit_force ? 1 : 0;
}

/// Counted as explicit, which they are to methods that need them.
void Forces::unconstrained_force(double t, const Vectors& x, const Vectors& v, Vectors& f) {
  ++explicit_forces_;
  add_up(unconstrained_law_, configuration(t, x, v), f);
  add_springs(x, f);
  for (const CountedTerm& counted : terms_) *counted.evaluations += counted.in_unconstrained_force ? 1 : 0;
}

bool Forces::has_constraints() const {
  return std::ranges::any_of(terms_, [](const CountedTerm& counted) { return bool(counted.term.list_constraints); });
}

std::vector<solver::CompliantConstraint> Forces::constraints() const {
  std::vector<solver::CompliantConstraint> all;
  for (const CountedTerm& counted : terms_)
    if (counted.term.list_constraints) counted.term.list_constraints(all);
  return all;
}

bool Forces::has_active() const {
  return active_law_ || std::ranges::any_of(terms_, [](const CountedTerm& counted) { return counted.term.active; });
}

double Forces::energy(const Vectors& x) const {
  double energy = 0;
  for (const CountedTerm& counted : terms_)
    if (counted.term.energy) energy += counted.term.energy(x);
  return energy;
}

void Forces::mean_excess(const Vectors& x0, const Vectors& x1, Vectors& f) const {
  for (const CountedTerm& counted : terms_)
    if (counted.term.mean_excess) counted.term.mean_excess(x0, x1, f);
}

void Forces::jacobian(double t, const Vectors& x, const Vectors& v, ExactJacobian& matrix, SparseMatrix& df_dx,
                      SparseMatrix& df_dv) {
  ++jacobians_;
  const Configuration c = configuration(t, x, v);
  matrix.assemble([&](const JacobianEntries& entries) { visit(c, entries); }, df_dx, df_dv);
}

void Forces::visit(const Configuration& c, const JacobianEntries& entries) const {
  for (const CountedTerm& counted : terms_)
    if (counted.term.jacobian) counted.term.jacobian(c, entries);
}

void Forces::newton_matrix(double t, const Vectors& x, const Vectors& v, double gamma, NewtonMatrix& matrix, SparseMatrix& J) {
  ++newton_matrices_;
  const Configuration c = configuration(t, x, v);
  matrix.assemble([&](const JacobianEntries& entries) { visit(c, entries); }, gamma, J);
}

SparseMatrix Forces::edge_matrix(const WeftWarp& modulus) const {
  return spring_matrix(grid_, [&](const Edge& edge) { return along(modulus, edge) * edge.width / edge.length; });
}

/// Particles that a cut leaves outside are pinned, with the mass of the others on average.
Eigen::VectorXd masses(const Sheet& sheet) {
  const Eigen::VectorXd areas = sheet.grid.cell_areas();
  const double mean = areas.sum() / static_cast<double>((areas.array() > 0).count());
  return sheet.material.density * (areas.array() > 0).select(areas, mean);
}

/// The sheet of a scene with its rest shape. `start`: positions at t = 0.
Sheet sheet_of(const Scene& scene, const Vectors& start) {
  Sheet sheet = scene.sheet;
  if (scene.rest == RestShape::start) sheet.rest = start;
  return sheet;
}

int count_fixed(const std::vector<solver::Pin>& pins) {
  int count = 0;
  for (const solver::Pin& pin : pins) count += pin.fixed[0] + pin.fixed[1] + pin.fixed[2];
  return count;
}

/// Lets the obstacles act, by constraints in the solver, or by forces, which it returns.
std::shared_ptr<Reaction> respond(const ContactRule& rule, const std::shared_ptr<Contacts>& contacts, solver::SplitOde& ode) {
  if (rule.response == ResponseKind::constraint) {
    ode.contacts = [contacts](double t, double h, const solver::State& y, std::vector<solver::Contact>& found) {
      contacts->find(t, h, y, found);
    };
    return {};
  }
  ode.compliant_constraints = {};  // a reaction depends on the whole force
  ode.unconstrained_force = {};
  auto reaction = std::make_shared<Reaction>(contacts, rule, ode.mass);
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
  return reaction;
}

/// Where pins move: there the whole force.
void keep_moved(const std::vector<solver::Pin>& pins, const Vectors& whole, Vectors& f) {
  for (const solver::Pin& pin : pins)
    for (int c = 0; c < 3; ++c)
      if (pin.fixed[c] && pin.velocity[c] != 0) f(pin.particle, c) -= whole(pin.particle, c);
}

bool moves(const solver::Pin& pin) {
  return (pin.fixed[0] && pin.velocity[0] != 0) || (pin.fixed[1] && pin.velocity[1] != 0) ||
         (pin.fixed[2] && pin.velocity[2] != 0);
}

/// Cloth::given.
solver::SplitOde::Force given(const std::shared_ptr<Forces>& forces, const std::shared_ptr<Reaction>& reaction,
                              const solver::SplitOde& ode) {
  const bool moved = std::ranges::any_of(ode.pins, moves), active = forces->has_active();
  std::int64_t& evaluations = ode.work->counter("guard_forces", "evaluations of forces by the energy guard");
  if (!moved && !active && !reaction) return {};
  return [=, &evaluations, work = ode.work, pins = ode.pins, whole = Vectors(), total = Vectors()](
             double t, const Vectors& x, const Vectors& v, Vectors& f) mutable {
    ++evaluations;
    if (active)
      forces->active(t, x, v, f);
    else
      f.setZero(x.rows(), 3);
    const bool reacts = reaction && reaction->acts(t, x);
    if (!moved && !reacts) return;
    forces->whole(t, x, v, whole);
    total = whole;
    if (reacts) reaction->add(v, whole, total);
    f += total - whole;
    if (moved) keep_moved(pins, total, f);
  };
}

}  // namespace

Cloth compile(const Scene& scene) {
  Cloth cloth;
  cloth.start = start(scene);
  solver::SplitOde& ode = cloth.ode;
  const auto forces = std::make_shared<Forces>(sheet_of(scene, cloth.start.x), *ode.work, cloth.plan);
  ode.mass = masses(scene.sheet);
  ode.pins = pins(scene);
  ode.stiffness = forces->stiffness();
  ode.damping = forces->damping();
  ode.force = [forces](double t, const Vectors& x, const Vectors& v, Vectors& f) { forces->force(t, x, v, f, true); };
  ode.explicit_force = [forces](double t, const Vectors& x, const Vectors& v, Vectors& f) { forces->force(t, x, v, f, false); };
  if (forces->has_constraints()) {
    ode.compliant_constraints = [forces] { return forces->constraints(); };
    ode.unconstrained_force = [forces](double t, const Vectors& x, const Vectors& v, Vectors& f) {
      forces->unconstrained_force(t, x, v, f);
    };
  }
  ode.potential_energy = [forces](double, const Vectors& x) { return forces->energy(x); };
  ode.mean_excess = [forces](double, const Vectors& x0, const Vectors& x1, Vectors& f) { forces->mean_excess(x0, x1, f); };
  if (const int count = forces->memory().variables(); count > 0) {
    ode.memory = std::shared_ptr<solver::Memory>(forces, &forces->memory());
    cloth.start.z.setZero(count);
    forces->memory().set_stiffness(ode.stiffness);
    ode.memory->begin(1, 0, cloth.start);
    ode.stiffness = ode.memory->stiffness();
  }
  ode.without_energy = cloth.plan.without_energy;
  ode.jacobian = [forces, exact = ExactJacobian(3 * ode.particles())](double t, const Vectors& x, const Vectors& v,
                                                                      SparseMatrix& df_dx, SparseMatrix& df_dv) mutable {
    forces->jacobian(t, x, v, exact, df_dx, df_dv);
  };
  ode.newton_matrix = [forces, tension = NewtonMatrix(Curvature::tension, ode.mass, ode.pins),
                       convex = NewtonMatrix(Curvature::convex, ode.mass, ode.pins)](
                          double t, const Vectors& x, const Vectors& v, double gamma, solver::Jacobian part,
                          SparseMatrix& J) mutable {
    forces->newton_matrix(t, x, v, gamma, part == solver::Jacobian::tension ? tension : convex, J);
  };
  std::shared_ptr<Reaction> reaction;
  if (!scene.obstacles.empty()) {
    cloth.contacts = std::make_shared<Contacts>(contacts(scene, *ode.work));
    reaction = respond(scene.contact, cloth.contacts, ode);
  }
  cloth.given = given(forces, reaction, ode);
  solver::prescribe(ode.pins, cloth.start.v);
  cloth.plan.obstacles = static_cast<int>(scene.obstacles.size());
  cloth.plan.particles = ode.particles();
  cloth.plan.pinned_dofs = count_fixed(ode.pins);
  cloth.plan.stiffness_entries = static_cast<int>(ode.stiffness.nonZeros());
  cloth.plan.damping_entries = static_cast<int>(ode.damping.nonZeros());
  return cloth;
}

std::vector<std::string> forces_without_energy(const Sheet& sheet) {
  std::vector<std::string> names;
  for (const TermKind& kind : term_kinds())
    if (const std::optional<Term> term = kind.make(sheet); term && term->without_energy) names.emplace_back(kind.name);
  return names;
}

std::string to_string(const Plan& plan) {
  return fmt::format(
      "{} particles, {} of {} degrees of freedom pinned; forces: {}; normals: {}; internal variables: {}; obstacles: {}; "
      "entries of K: {}, of D: {}",
      plan.particles, plan.pinned_dofs, 3 * plan.particles,
      plan.terms.empty() ? "none" : fmt::format("{}", fmt::join(plan.terms, ", ")), plan.normals ? "yes" : "no",
      plan.internal_variables, plan.obstacles, plan.stiffness_entries, plan.damping_entries);
}

}  // namespace drape::model
