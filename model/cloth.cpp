#include "model/cloth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/adaptive/adaptive_springs.hpp"
#include "model/collision/cloth_pairs.hpp"
#include "model/garment_forces.hpp"
#include "model/obstacles/reaction.hpp"
#include "model/obstacles/relocation.hpp"
#include "model/obstacles/repulsion.hpp"
#include "model/phases.hpp"

namespace drape::model {
namespace {

int count_fixed(const std::vector<solver::Pin>& pins) {
  int count = 0;
  for (const solver::Pin& pin : pins) count += static_cast<int>(std::lround(pin.held.trace()));
  return count;
}

/// The forces of obstacles, if that is how they act: at most one of the first two is not null.
struct ContactForces {
  std::shared_ptr<Reaction> reaction;
  std::shared_ptr<Repulsion> repulsion;
  std::shared_ptr<AdaptiveSprings> adaptive;

  bool any() const { return reaction || repulsion || adaptive; }
};

/// Adds the forces of springs that obstacles divide to those of the ODE; null if no obstacle has edges.
std::shared_ptr<AdaptiveSprings> adapt(const Scene& scene, const Garment& garment, GarmentForces& forces,
                                       solver::SplitOde& ode) {
  BodySurface bodies(scene.obstacles);
  if (bodies.empty()) return {};
  const Garment::Panel& panel = garment.panels().front();
  auto adaptive = std::make_shared<AdaptiveSprings>(panel.sheet, ClothSurface(garment).triangles(), garment.start().x,
                                                    std::move(bodies), ode);
  ode.compliant_constraints = {};  // which stand for whole springs
  ode.unconstrained_force = {};
  ode.force = [=, others = ode.force](double t, const Vectors& x, const Vectors& v, Vectors& f) {
    others(t, x, v, f);
    adaptive->add(t, x, v, f);
  };
  ode.explicit_force = [=, others = ode.explicit_force](double t, const Vectors& x, const Vectors& v, Vectors& f) {
    others(t, x, v, f);
    adaptive->add_explicit(t, x, v, f);
  };
  forces.also_visit([adaptive](double t, const Vectors& x, const Vectors& v, const JacobianEntries& entries) {
    adaptive->visit(t, x, v, entries);
  });
  ode.without_energy.emplace_back("virtual particles");
  ode.step_forces = adaptive;
  return adaptive;
}

std::shared_ptr<Repulsion> repel(const ContactRule& rule, const std::shared_ptr<Contacts>& contacts, GarmentForces& forces,
                                 solver::SplitOde& ode) {
  auto repulsion = std::make_shared<Repulsion>(contacts, rule, ode.mass);
  for (solver::SplitOde::Force* const part : {&ode.force, &ode.explicit_force, &ode.unconstrained_force})
    if (*part)
      *part = [=, others = *part](double t, const Vectors& x, const Vectors& v, Vectors& f) {
        others(t, x, v, f);
        repulsion->add(t, x, v, f);
      };
  forces.also_visit([repulsion](double t, const Vectors& x, const Vectors& v, const JacobianEntries& entries) {
    const Repulsion::Derivatives& all = repulsion->derivatives(t, x, v, entries.exact());
    for (int i = 0; i < static_cast<int>(all.by_x.size()); ++i) entries.add_dx(i, i, all.by_x[static_cast<std::size_t>(i)]);
    for (int i = 0; i < static_cast<int>(all.by_v.size()); ++i) entries.add_dv(i, i, all.by_v[static_cast<std::size_t>(i)]);
  });
  ode.without_energy.emplace_back(rule.response == ResponseKind::penalty ? "penalty" : "field");
  return repulsion;
}

std::shared_ptr<Reaction> react(const ContactRule& rule, const std::shared_ptr<Contacts>& contacts, solver::SplitOde& ode) {
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

/// Lets the obstacles act, by constraints in the solver, after steps, or by forces, which it returns.
ContactForces respond(const ContactRule& rule, const std::shared_ptr<Contacts>& contacts, GarmentForces& forces,
                      solver::SplitOde& ode) {
  if (rule.response == ResponseKind::reaction) return {react(rule, contacts, ode), {}, {}};
  if (is_force(rule.response)) return {{}, repel(rule, contacts, forces, ode), {}};
  if (relocates(rule.response))
    ode.relocate = Relocation(contacts, rule);
  else
    ode.contacts = [contacts](double t, double h, const solver::State& y, std::vector<solver::Contact>& found) {
      contacts->find(t, h, y, found);
    };
  return {};
}

bool moves(const solver::Pin& pin) { return !pin.prescribed().isZero(0); }

/// Where pins move: there the whole force.
void keep_moved(const std::vector<solver::Pin>& pins, const Vectors& whole, Vectors& f) {
  for (const solver::Pin& pin : pins)
    if (moves(pin)) f.row(pin.particle) -= whole.row(pin.particle) * pin.held;
}

/// Cloth::given.
solver::SplitOde::Force given(const std::shared_ptr<GarmentForces>& forces, const ContactForces& contact,
                              const solver::SplitOde& ode) {
  const bool moved = std::ranges::any_of(ode.pins, moves), active = forces->has_active();
  std::int64_t& evaluations = ode.work->counter("guard_forces", "evaluations of forces by the energy guard");
  if (!moved && !active && !contact.any()) return {};
  return [=, &evaluations, work = ode.work, pins = ode.pins, whole = Vectors(), total = Vectors()](
             double t, const Vectors& x, const Vectors& v, Vectors& f) mutable {
    ++evaluations;
    if (active)
      forces->uncounted_force(ForcePart::active, t, x, v, f);
    else
      f.setZero(x.rows(), 3);
    const bool reacts = contact.reaction && contact.reaction->acts(t, x);
    if (!moved && !reacts && !contact.repulsion && !contact.adaptive) return;
    forces->uncounted_force(ForcePart::whole, t, x, v, whole);
    total = whole;
    if (contact.adaptive) contact.adaptive->add(t, x, v, total);
    if (reacts) contact.reaction->add(v, Vectors(total), total);
    if (contact.repulsion) contact.repulsion->add(t, x, v, total);
    f += total - whole;
    if (moved) keep_moved(pins, total, f);
  };
}

}  // namespace

Cloth compile(const Scene& scene) {
  const Scene first = phases(scene).front();
  auto garment = std::make_shared<const Garment>(first);
  solver::State start = garment->start();
  return compile(first, std::move(garment), std::move(start), std::make_shared<solver::Counters>());
}

Cloth compile(const Scene& scene, std::shared_ptr<const Garment> garment, solver::State start,
              std::shared_ptr<solver::Counters> work) {
  Cloth cloth;
  cloth.garment = std::move(garment);
  cloth.begin = scene.begin;
  cloth.start = std::move(start);
  solver::SplitOde& ode = cloth.ode;
  ode.work = std::move(work);
  const auto forces = std::make_shared<GarmentForces>(cloth.garment, *ode.work);
  cloth.plan.terms = forces->names();
  cloth.plan.without_energy = forces->without_energy();
  cloth.plan.normals = forces->needs_normals();
  cloth.plan.internal_variables = forces->memory().variables();
  ode.mass = cloth.garment->masses();
  ode.pins = cloth.garment->pins(scene, cloth.start.x);
  ode.stiffness = forces->stiffness();
  ode.damping = forces->damping();
  const auto part_of = [&](ForcePart part) -> solver::SplitOde::Force {
    return [forces, part](double t, const Vectors& x, const Vectors& v, Vectors& f) { forces->force(part, t, x, v, f); };
  };
  ode.force = part_of(ForcePart::whole);
  ode.explicit_force = part_of(ForcePart::explicit_part);
  if (forces->has_constraints()) {
    ode.compliant_constraints = [forces] { return forces->constraints(); };
    ode.unconstrained_force = part_of(ForcePart::unconstrained);
  }
  ode.potential_energy = [forces](double, const Vectors& x) { return forces->energy(x); };
  ode.mean_excess = [forces](double, const Vectors& x0, const Vectors& x1, Vectors& f) { forces->mean_excess(x0, x1, f); };
  if (const int count = forces->memory().variables(); count > 0) {
    ode.memory = std::shared_ptr<solver::Memory>(forces, &forces->memory());
    if (cloth.start.z.size() != count) cloth.start.z.setZero(count);
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
  ContactForces contact;
  if (!scene.obstacles.empty()) {
    cloth.contacts = std::make_shared<Contacts>(contacts(scene, *ode.work));
    std::shared_ptr<AdaptiveSprings> adaptive;
    if (scene.contact.adaptive) adaptive = adapt(scene, *cloth.garment, *forces, ode);
    contact = respond(scene.contact, cloth.contacts, *forces, ode);
    contact.adaptive = std::move(adaptive);
  }
  const std::span<const ObstacleRule> met = scene.contact.faces ? std::span(scene.obstacles) : std::span<const ObstacleRule>();
  if (scene.contact.thickness > 0 || !met.empty())
    ode.pairs = std::make_shared<ClothPairs>(ClothSurface(*cloth.garment), scene.contact, met, *ode.work);
  cloth.given = given(forces, contact, ode);
  solver::prescribe(ode.pins, cloth.start.v);
  cloth.plan.obstacles = static_cast<int>(scene.obstacles.size());
  cloth.plan.particles = ode.particles();
  cloth.plan.pinned_dofs = count_fixed(ode.pins);
  cloth.plan.stiffness_entries = static_cast<int>(ode.stiffness.nonZeros());
  cloth.plan.damping_entries = static_cast<int>(ode.damping.nonZeros());
  return cloth;
}

std::vector<std::string> forces_without_energy(const Scene& scene) {
  solver::Counters unused;
  return GarmentForces(std::make_shared<const Garment>(scene), unused).without_energy();
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
