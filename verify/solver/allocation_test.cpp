// Steps allocate no memory.

#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <memory>
#include <vector>

#include "model/cloth.hpp"
#include "model/obstacles/posed_mesh.hpp"
#include "model/scene_file/scene_file.hpp"
#include "verify/support/mesh_files.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/small_problems.hpp"

namespace {
std::atomic<std::int64_t> allocations = 0;
}

// All ways to memory lead through malloc and its relatives, `new` and the libraries of others included.
#ifdef DRAPE_SANITIZE
// Declared here because g++ 12 ships the function without its header.
// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*)(const volatile void*, std::size_t),
                                                         void (*)(const volatile void*));

namespace {
const int installed = __sanitizer_install_malloc_and_free_hooks([](const volatile void*, std::size_t) { ++allocations; },
                                                                [](const volatile void*) {});
}
#else
// The C library's own, which the linker would have taken if we had not defined these here.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) noexcept { return ++allocations, __libc_malloc(size); }
void* calloc(std::size_t count, std::size_t size) noexcept { return ++allocations, __libc_calloc(count, size); }
void* realloc(void* old, std::size_t size) noexcept { return ++allocations, __libc_realloc(old, size); }
void* memalign(std::size_t alignment, std::size_t size) noexcept { return ++allocations, __libc_memalign(alignment, size); }
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept { return memalign(alignment, size); }
int posix_memalign(void** result, std::size_t alignment, std::size_t size) noexcept {
  *result = memalign(alignment, size);
  return *result ? 0 : ENOMEM;
}
}
#endif

namespace drape::verify::allocation_test {
namespace {

using namespace small_problems;
using solver::Integrator;
using solver::Outcome;

/// Allocations while f runs.
template <class F>
std::int64_t allocations_of(const F& f) {
  const std::int64_t before = allocations;
  f();
  return allocations - before;
}

void* volatile last_used = nullptr;

/// Keeps the compiler from leaving out an unused allocation.
void* used(void* memory) {
  last_used = memory;
  return memory;
}

TEST(AllocationCounter, SeesAllWaysToAllocate) {
  EXPECT_EQ(allocations_of([] {}), 0);
  EXPECT_EQ(allocations_of([] { used(std::vector<double>(100).data()); }), 1);
  EXPECT_EQ(allocations_of([] { used(Vectors(100, 3).data()); }), 1);
  EXPECT_EQ(allocations_of([] { delete static_cast<int*>(used(new int)); }), 1);
  EXPECT_EQ(allocations_of([] { std::free(used(std::malloc(100))); }), 1);
  EXPECT_EQ(allocations_of([] { std::free(used(std::calloc(10, 10))); }), 1);
  EXPECT_EQ(allocations_of([] { std::free(used(std::realloc(nullptr, 100))); }), 1);
  EXPECT_EQ(allocations_of([] { std::free(used(std::aligned_alloc(64, 128))); }), 1);
  void* memory = nullptr;
  EXPECT_EQ(allocations_of([&] { EXPECT_EQ(posix_memalign(&memory, 64, 128), 0); }), 1);
  std::free(memory);
}

/// Allocations of 50 steps after those that begin a history.
std::int64_t allocations_of_steps(const model::Cloth& cloth, const Method& method, const Options& options) {
  Integrator integrator(cloth.ode, method, options, cloth.start);
  const auto steps = [&](int n) {
    for (int k = 0; k < n; ++k) EXPECT_EQ(integrator.step(2e-4).outcome, Outcome::success);
  };
  steps(method.history + 2);
  return allocations_of([&] { steps(50); });
}

class Allocations : public testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  const Method& method = solver::method(std::get<0>(GetParam()));
  Options options;

  void SetUp() override {
    if (method.stages == Method::Stages::none && !method.sub_steps) GTEST_SKIP() << "not stable on these; ExplicitMethods";
    const bool exact = method.stages == Method::Stages::linearised || method.stages == Method::Stages::exponential;
    const bool usual = std::get<1>(GetParam()) == "auto";
    if (exact && !usual) GTEST_SKIP() << "solves no system with the constant matrix";
    DRAPE_SLOW_IF(!method.in_thesis && !usual);
    options.linear_solver = &solver::linear_solver(std::get<1>(GetParam()));
  }

  std::int64_t of_steps(const model::Cloth& cloth, const Options& chosen) {
    return allocations_of_steps(cloth, method, chosen);
  }
};
INSTANTIATE_TEST_SUITE_P(, Allocations,
                         testing::Combine(testing::ValuesIn(names(solver::methods())),
                                          testing::ValuesIn(names(solver::linear_solvers()))),
                         [](const auto& test) { return identifier(std::get<0>(test.param)) + "_" + std::get<1>(test.param); });

TEST_P(Allocations, DoNotHappenInStepsOfAHungSheet) {
  const model::Override small[] = {{"grid.n", "10"}};
  EXPECT_EQ(of_steps(model::compile(model::load_scene("hung-edge", small)), options), 0);
}

TEST_P(Allocations, DoNotHappenInStepsWithAllForces) {
  DRAPE_SLOW();
  const model::Override windy[] = {{"forces.wind", "[1, 2, 3]"},
                                   {"forces.lift", "0.5"},
                                   {"forces.air", "0.1"},
                                   {"material.bend_projected", method.needs_energies ? "false" : "true"}};
  EXPECT_EQ(of_steps(model::compile(model::load_scene("pulled", windy)), options), 0);
}

TEST(ExplicitMethods, DoNotAllocate) {
  const model::Override soft[] = {{"grid.n", "10"}, {"material.damping", "0.5"}};
  for (const char* name : {"explicit-euler", "explicit-midpoint", "rk4", "rkl2", "rkc2", "rock2"}) {
    const model::Cloth cloth = model::compile(model::load_scene("hung-edge", soft));
    EXPECT_EQ(allocations_of_steps(cloth, solver::method(name), {}), 0) << name;
  }
}

TEST(StageSolvers, DoNotAllocate) {
  const model::Override small[] = {{"grid.n", "10"}};
  const model::Cloth cloth = model::compile(model::load_scene("hung-edge", small));
  using Matrix = solver::StageKind::Matrix;
  for (const solver::StageKind& kind : solver::stage_kinds()) {
    if (kind.matrix != Matrix::constant && kind.matrix != Matrix::chosen) continue;  // a new factor needs memory
    Options options;
    options.stage = &kind;
    EXPECT_EQ(allocations_of_steps(cloth, solver::method("bdf2"), options), 0) << kind.name;
  }
}

TEST(MovingMesh, DoesNotAllocateWhenItIsSetToATimeAndAsked) {
  const model::TriangleMesh mesh = spiky_mesh(1), thin = spiky_mesh(0.5);
  const std::vector<model::KeyVertices> keys{{0, "", mesh.vertices}, {1, "", thin.vertices}};
  model::PosedMesh posed(std::make_shared<model::MovingMesh>(mesh, keys));
  EXPECT_EQ(allocations_of([&] {
              for (const double t : {0.5, 0.25, 2.0}) {
                posed.set_time(t);
                posed.velocity(posed.touch({0.3, 0.4, 2}).at);
              }
            }),
            0);
}

TEST_P(Allocations, AreSeenIfTheForceAllocates) {
  const model::Override small[] = {{"grid.n", "10"}};
  model::Cloth cloth = model::compile(model::load_scene("hung-edge", small));
  for (auto* f : {&cloth.ode.force, &cloth.ode.explicit_force, &cloth.ode.unconstrained_force})
    *f = [original = *f](double t, const Vectors& x, const Vectors& v, Vectors& force) {
      used(std::vector<double>(1).data());
      original(t, x, v, force);
    };
  EXPECT_GE(of_steps(cloth, options), 50);
}

}  // namespace
}  // namespace drape::verify::allocation_test
