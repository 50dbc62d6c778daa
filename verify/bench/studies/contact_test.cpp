// The study of contact: what is watched of a run, and its short form.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bench/runs/record.hpp"
#include "bench/studies/contact/contact_watch.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/file/run_file.hpp"
#include "solver/methods.hpp"
#include "verify/support/bench_integrators.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify::contact_study_test {
namespace {

using bench::ContactFindings;
using results::Table;
using testing::AllOf;
using testing::Gt;
using testing::Lt;
using testing::Optional;
using testing::SizeIs;

struct Watched {
  results::RunRecord run;
  ContactFindings found;
};

Watched watched(const std::string& toml, const char* method = "midpoint") {
  const model::Scene scene = model::parse_scene("name = 'test'\n" + toml, "test");
  bench::ContactWatch watch;
  bench::Observer* const observers[] = {&watch};
  results::RunRecord run = bench::record({scene, "", &solver::method(method), 0.01, solver::thesis_options()}, observers);
  return {std::move(run), watch.findings()};
}

const std::string cloth =
    "grid = { n = 8, size = 0.2 }\nmaterial = { density = 0.3, tension = 200, damping = 0.2, shear = 10, bend = 1e-5 }\n";

TEST(ContactWatch, SeesPairsAndTheirDistance) {
  const auto [run, found] = watched(cloth +
                                    "contact = { thickness = 0.005 }\nend = { time = 0.06 }\n[[panels]]\nname = 'lower'\n"
                                    "[[panels]]\nname = 'upper'\nstart.position = [0.0071, 0.0043, 0.022]\n"
                                    "start.velocity = [0, 0, -1]\n");
  ASSERT_TRUE(run.succeeded());
  ASSERT_THAT(found.pairs, SizeIs(run.steps.size()));
  EXPECT_EQ(found.pairs.front(), 0);
  EXPECT_GT(found.pairs.back(), 0);
  EXPECT_EQ(found.intersecting + found.in_bodies + found.through_bodies, 0);
  EXPECT_THAT(found.least, Optional(AllOf(Gt(0.9), Lt(1.05))));
  EXPECT_THAT(found.energy_rise, Optional(Lt(1e-3)));
}

TEST(ContactWatch, BalancesMomentumWithTheImpulsesOfObstacles) {
  const auto [run, found] = watched(cloth +
                                    "forces.gravity = [0, 0, -9.81]\nobstacles = [{ shape = 'plane' }]\n"
                                    "start.position = [0, 0, 0.05]\nend = { time = 0.3 }\n");
  ASSERT_TRUE(run.succeeded());
  EXPECT_GT(run.steps.back().contacts, 0);
  EXPECT_THAT(found.momentum, Optional(Lt(1e-3)));
}

TEST(ContactWatch, BalancesMomentumWithTheImpulsesOfVirtualParticles) {
  const auto [run, found] =
      watched(cloth +
                  "forces.gravity = [0, 0, -9.81]\ncontact = { adaptive = true, distance = 1e-3 }\nend = { time = 0.3 }\n"
                  "obstacles = [{ shape = 'box', size = [0.01, 0.4, 0.1], position = [0.1, 0.1, -0.055] }]\n",
              "implicit-euler");
  ASSERT_TRUE(run.succeeded());
  EXPECT_EQ(run.steps.back().contacts, 0) << "the bar is between particles";
  EXPECT_THAT(found.momentum, Optional(Lt(1e-3)));
  EXPECT_FALSE(found.energy_rise);
}

TEST(ContactWatch, SaysNothingOfBalancesWherePinsGive) {
  const auto [run, found] = watched(cloth + "pins = [{ where = 'left edge', velocity = [-0.1, 0, 0] }]\nend.time = 0.05\n");
  ASSERT_TRUE(run.succeeded());
  EXPECT_FALSE(found.momentum);
  EXPECT_FALSE(found.energy_rise);
}

/// Seams bring particles together and merge them: contact leaves them alone, and the frames after are those of fewer nodes.
TEST(ContactWatch, SeesSeamsThatContactLeavesAlone) {
  const auto [run, found] =
      watched(cloth +
              "contact.thickness = 0.005\nphases = [{ until = 0.1, seams = 'pulled' }]\nend = { time = 0.2 }\n"
              "[[panels]]\nname = 'one'\n[[panels]]\nname = 'other'\nstart.position = [0.23, 0, 0.02]\n"
              "[[seams]]\none = { panel = 'one', side = 'right' }\nother = { panel = 'other', side = 'left' }\n");
  ASSERT_TRUE(run.succeeded());
  EXPECT_EQ(run.steps.size(), 20u);
  EXPECT_FALSE(found.least);
  EXPECT_EQ(found.intersecting, 0);
  EXPECT_EQ(results::work_count(run, "pair_changes"), 0);
  EXPECT_FALSE(found.momentum) << "seams that are pulled give momentum";
}

TEST(ContactWatch, SaysNothingOfEnergyWhereObstaclesMove) {
  const auto [run, found] = watched(cloth +
                                    "forces.gravity = [0, 0, -9.81]\nend = { time = 0.05 }\n"
                                    "obstacles = [{ shape = 'plane', motion = [{ time = 0, position = [0, 0, -0.02] }, "
                                    "{ time = 1, position = [0, 0, 0.98] }] }]\n");
  ASSERT_TRUE(run.succeeded());
  EXPECT_GT(run.steps.back().contacts, 0);
  EXPECT_FALSE(found.energy_rise);
  EXPECT_THAT(found.momentum, Optional(Lt(1e-3)));
}

TEST(ContactWatch, SeesClothThroughItselfAndThroughBodies) {
  const Watched crossing = watched(cloth +
                                   "end = { time = 0.02 }\n[[panels]]\nname = 'lower'\n[[panels]]\nname = 'upper'\n"
                                   "start.position = [0.02, 0.01, -0.02]\nstart.rotation = [20, 0, 0]\n");
  EXPECT_EQ(crossing.found.intersecting, 3) << "the start and two steps";
  const Watched pierced = watched(
      "grid = { n = 2, size = 0.2 }\nobstacles = [{ shape = 'box', size = [0.05, 0.05, 0.1], position = [0.1, 0.1, 0] }]\n"
      "contact.distance = 0.001\nend = { time = 0.02 }\n");
  EXPECT_EQ(pierced.found.through_bodies, 3);
  EXPECT_EQ(pierced.found.in_bodies, 0);
  EXPECT_EQ(pierced.found.intersecting, 0);
}

TEST(ContactStudy, JudgesStacksAndComparesResponses) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  program.output({"study", "contact", "--quick", "--out", "study.h5"});
  const std::vector<Table> all = results::read_tables(program.folder() / "study.h5");  // in the order of their names
  ASSERT_THAT(all, SizeIs(4));
  const Table &contact = all[0], &responses = all[1], &steps = all[2], &verdicts = all[3];
  ASSERT_EQ(rows(contact), 2u) << "sbdf2 and verlet on the stack";
  for (std::size_t row = 0; row < rows(contact); ++row) {
    const auto number = [&](const char* name) { return number_in(find_column(contact, name), row); };
    EXPECT_EQ(text_in(find_column(contact, "outcome"), row), "success");
    EXPECT_GT(number("pairs"), 0);
    EXPECT_GE(number("most_pairs"), number("pairs"));
    EXPECT_EQ(number("intersecting"), 0);
    EXPECT_GT(number("detection"), 0);
    EXPECT_GE(number("largest_step"), 0.01);
    EXPECT_LT(number("momentum"), 1e-3);
  }
  EXPECT_TRUE(steps.for_file);
  EXPECT_EQ(rows(steps), 2u * 80);
  ASSERT_EQ(rows(verdicts), 2u + 1) << "verlet solves no systems";
  for (std::size_t row = 0; row < 2; ++row) EXPECT_EQ(text_in(find_column(verdicts, "verdict"), row), "met: no intersection");
  ASSERT_EQ(rows(responses), 8u);
  for (std::size_t row = 0; row < rows(responses); ++row)
    EXPECT_EQ(text_in(find_column(responses, "verdict"), row).empty(),
              text_in(find_column(responses, "response"), row) == "constraint");
}

}  // namespace
}  // namespace drape::verify::contact_study_test
