// Order in time: every method follows small sheets of every force, alone and together, whose motion was chosen beforehand.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "solver/integrator.hpp"
#include "verify/support/convergence.hpp"
#include "verify/support/manufactured_materials.hpp"
#include "verify/support/manufactured_sheets.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::manufactured_time_test {
namespace {

using namespace manufactured;
using small_problems::identifier;
using small_problems::names;
using small_problems::tight;
using solver::Method;

constexpr double duration = 0.6;  // [s]

/// The largest distance of positions and velocities from the exact ones on the way.
struct Errors {
  double x = 0, v = 0;
};

Errors errors(const Problem& problem, const Method& method, int steps, const solver::Options& options) {
  Errors largest_errors;
  solver::Integrator integrator(problem.ode, method, options, problem.start, start_time);
  const auto run = integrate(integrator, start_time + duration, duration / steps, [&](const solver::StepReport& step) {
    const State exact = problem.exact(step.t);
    largest_errors.x = std::max(largest_errors.x, l2_norm(problem.ode, step.y.x - exact.x));
    largest_errors.v = std::max(largest_errors.v, l2_norm(problem.ode, step.y.v - exact.v));
  });
  EXPECT_EQ(run.outcome, solver::Outcome::success) << run.message;
  return largest_errors;
}

struct Measured {
  Convergence x, v;

  void add(double h, const Errors& e) {
    x.steps.push_back(h), x.errors.push_back(e.x);
    v.steps.push_back(h), v.errors.push_back(e.v);
  }
};

/// What is missing at the nodes, M s_tt − f(t, s, s_t), remembered for as long as the time stays.
class NodalLoad {
 public:
  NodalLoad(const Grid& grid, const Motion& motion, const SplitOde& ode)
      : nodes_(grid, surface(motion)), mass_(ode.mass), force_(ode.force) {}

  const Vectors& at(double t) {
    if (t == time_) return load_;
    time_ = t;
    const auto [x, v, z] = nodes_.state(t);
    force_(t, x, v, load_);
    for (int i = 0; i < x.rows(); ++i) load_.row(i) = mass_[i] * nodes_.jet(i, t).acceleration.transpose() - load_.row(i);
    return load_;
  }

 private:
  Nodes nodes_;
  Eigen::VectorXd mass_;
  SplitOde::Force force_;
  std::optional<double> time_;
  Vectors load_;
};

/// A sheet whose exact solution is the surface at the nodes: nothing is left but the error in time.
Problem exact_at_nodes(const Material& material, const Motion& motion) {
  const Grid mesh{5, 4, size_u, size_v};
  Problem problem = unloaded(mesh, material, motion);
  const auto load = std::make_shared<NodalLoad>(mesh, motion, problem.ode);
  add_load(problem.ode, [load](double t, const Vectors&, const Vectors&, Vectors& f) { f += load->at(t); });
  return problem;
}

Measured in_time(const Problem& problem, const Method& method) {
  Measured measured;
  const int first = method.name.starts_with("ros34pw2") ? 90 : 60;  // from where on the order rules
  for (const int n : {first, 2 * first, 4 * first, 8 * first}) measured.add(duration / n, errors(problem, method, n, tight()));
  return measured;
}

using TimeCase = std::tuple<std::string, NamedMaterial, Motion>;

bool takes(const Method& method, const NamedMaterial& material) {
  model::Scene scene;
  scene.sheet = {five_by_four(), material.material};
  return !method.needs_energies || model::forces_without_energy(scene).empty();
}

/// Every force alone in the most general motion, all together in every motion.
std::vector<TimeCase> time_cases() {
  std::vector<TimeCase> all;
  for (const Method& method : small_problems::converging_methods())
    for (const NamedMaterial& material : single_materials())
      for (const Motion& motion : motions())
        if (method.order <= 3 && takes(method, material) && motion.moving &&
            (material.name.starts_with("all") || (motion.curved && motion.free)))
          all.emplace_back(method.name, material, motion);
  return all;
}

std::string name_of_case(const testing::TestParamInfo<TimeCase>& test) {
  const auto& [method, material, motion] = test.param;
  return identifier(method) + "_" + material.name + "_" + motion.name();
}

class ManufacturedTime : public testing::TestWithParam<TimeCase> {};
INSTANTIATE_TEST_SUITE_P(, ManufacturedTime, testing::ValuesIn(time_cases()), name_of_case);

testing::AssertionResult has_order(const Measured& measured, double order) {
  const auto x = has_order(measured.x, order), v = has_order(measured.v, order);
  return testing::AssertionResult(x && v) << "positions: " << x.message() << "\nvelocities: " << v.message();
}

TEST_P(ManufacturedTime, OrderIsTheDeclaredOne) {
  const auto& [name, material, motion] = GetParam();
  DRAPE_SLOW_IF(material.name != "all");  // their forces are those of other tests
  const Method& method = solver::method(name);
  EXPECT_TRUE(has_order(in_time(exact_at_nodes(material.material, motion), method), method.order));
}

TEST(ManufacturedTimeCheck, RejectsALoadThatIsALittleOff) {
  const Motion general{.curved = true, .free = true, .moving = true};
  const Method& midpoint = solver::method("midpoint");
  Problem problem = exact_at_nodes(joint_materials().front().material, general);
  EXPECT_TRUE(has_order(in_time(problem, midpoint), 2));
  add_load(problem.ode, [](double, const Vectors&, const Vectors&, Vectors& f) { f(7, 2) += 1e-5; });
  EXPECT_FALSE(has_order(in_time(problem, midpoint), 2));
}

}  // namespace
}  // namespace drape::verify::manufactured_time_test
