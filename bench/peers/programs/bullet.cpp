// Bullet's deformable cloth on springs: compiled once for each of its two precisions, which are libraries with one ABI each.

#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableMassSpringForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <stdexcept>

#include "bench/peers/programs/program.hpp"

namespace drape::bench::peers {
namespace {

btVector3 vector(const double* a) { return {btScalar(a[0]), btScalar(a[1]), btScalar(a[2])}; }

void append(std::vector<double>& all, const btVector3& a) { all.insert(all.end(), {a[0], a[1], a[2]}); }

/// Bullet has one stiffness for edges, one for what bends, here the diagonals, and one drag for all springs.
struct Stiffness {
  double edge, diagonal, drag;

  explicit Stiffness(const Problem& problem) : edge(problem.stiffness.at(0)), diagonal(edge), drag(problem.drag.at(0)) {
    for (std::size_t k = 0; k < problem.ends.size(); ++k) {
      if (problem.stiffness[k] != edge && diagonal == edge) diagonal = problem.stiffness[k];
      if (problem.stiffness[k] != edge && problem.stiffness[k] != diagonal)
        throw std::runtime_error(
            "Bullet has one stiffness for edges and one for diagonals: expected grid.border_cells = \"whole\" and equal "
            "moduli");
      if (problem.drag[k] != drag)
        throw std::runtime_error("Bullet has one drag for all springs: expected material.damping = 0, or material.shear = 0");
    }
  }
};

/// A world in which nothing collides, with one body of springs.
class World {
 public:
  explicit World(const Problem& problem)
      : world_(&dispatcher_, &pairs_, &constraints_, &configuration_, &solver_),
        stiffness_(problem),
        springs_(stiffness_.edge, stiffness_.drag, problem.drag_along, stiffness_.diagonal),
        weight_(vector(problem.gravity.data())) {
    constraints_.setDeformableSolver(&solver_);
    const bool implicit = problem.integrator == "implicit";
    world_.setImplicit(implicit);
    world_.setUseProjection(implicit);  // else its implicit step is not solved
    world_.setLineSearch(false);
    world_.setGravity(vector(problem.gravity.data()));
    body_ = make_body(problem);
    world_.addSoftBody(body_);
    world_.addForce(body_, &springs_);
    world_.addForce(body_, &weight_);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  ~World() {
    world_.removeSoftBody(body_);
    delete body_;
  }

  void step(double h) { world_.stepSimulation(btScalar(h), 0); }

  void add_frame(Solved& solved) const {
    std::vector<double>&x = solved.positions.emplace_back(), &v = solved.velocities.emplace_back();
    for (int i = 0; i < body_->m_nodes.size(); ++i) {
      append(x, body_->m_nodes[i].m_x);
      append(v, body_->m_nodes[i].m_v);
    }
  }

 private:
  btSoftBody* make_body(const Problem& problem) {
    const int n = int(problem.mass.size());
    std::vector<btVector3> x;
    std::vector<btScalar> m;
    for (int i = 0; i < n; ++i) {
      x.push_back(vector(&problem.positions[std::size_t(3 * i)]));
      m.push_back(btScalar(problem.mass[std::size_t(i)]));
    }
    auto* body = new btSoftBody(&world_.getWorldInfo(), n, x.data(), m.data());
    for (std::size_t k = 0; k < problem.ends.size(); ++k) {
      body->appendLink(problem.ends[k][0], problem.ends[k][1]);
      btSoftBody::Link& link = body->m_links[int(k)];
      link.m_rl = btScalar(problem.rest[k]);
      link.m_bbending = problem.stiffness[k] != stiffness_.edge;
    }
    for (int i = 0; i < n; ++i) body->m_nodes[i].m_v = body->m_nodes[i].m_vn = vector(&problem.velocities[std::size_t(3 * i)]);
    for (const int i : problem.pinned) body->setMass(i, 0);
    body->m_sleepingThreshold = 0;
    body->setActivationState(DISABLE_DEACTIVATION);
    body->m_cfg.collisions = 0;
    world_.getWorldInfo().air_density = 0;
    return body;
  }

  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase pairs_;
  btDeformableBodySolver solver_;
  btDeformableMultiBodyConstraintSolver constraints_;
  btDeformableMultiBodyDynamicsWorld world_;
  Stiffness stiffness_;
  btDeformableMassSpringForce springs_;
  btDeformableGravityForce weight_;
  btSoftBody* body_ = nullptr;
};

Solved solve(const Problem& problem) {
  World world(problem);
  Solved solved{"Bullet " + std::to_string(btGetVersion() / 100) + "." + std::to_string(btGetVersion() % 100) + ", " +
                (sizeof(btScalar) == sizeof(double) ? "double" : "single") + " precision"};
  StepClock clock;
  std::int64_t done = 0;
  for (const std::int64_t until : problem.steps) {
    clock.time([&] {
      for (; done < until; ++done) world.step(problem.step);
    });
    world.add_frame(solved);
  }
  solved.seconds = clock.seconds();
  return solved;
}

}  // namespace
}  // namespace drape::bench::peers

int main(int argc, char** argv) { return drape::bench::peers::run_program(argc, argv, drape::bench::peers::solve); }
