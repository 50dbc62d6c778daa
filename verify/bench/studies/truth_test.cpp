// What errors of large sheets are measured against is what certificates say of small ones.

#include <gtest/gtest.h>

#include <cstddef>

#include "bench/runs/checkpoint.hpp"
#include "bench/studies/work_precision/work_precision.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/distance.hpp"
#include "solver/base/temporary.hpp"

namespace drape::verify::truth_test {
namespace {

using bench::Problem;

TEST(Truth, OfHalvedStepsIsTheCertifiedOne) {
  const base::TemporaryFolder folder;
  results::Journal journal(folder / "truth.journal", {}, results::Start::fresh);
  bench::Checkpoint checkpoint(journal, 1);
  const std::vector<model::Override> small{{"grid.n", "8"}, {"material.damping", "5"}, {"end.time", "0.3"}};
  const model::Scene scene = model::load_scene("hung-corners", small);
  checkpoint.begin("certified");
  const Problem certified = bench::certified_problem("sheet", scene, checkpoint);
  checkpoint.begin("stepped");
  const Problem stepped = bench::stepped_problem("sheet", scene, checkpoint);
  ASSERT_EQ(stepped.truth.size(), certified.truth.size());
  EXPECT_LE(stepped.uncertainty, 1e-8);
  EXPECT_GT(stepped.uncertainty, 0);
  for (std::size_t k = 0; k < certified.truth.size(); ++k)
    EXPECT_LE(reference::rms_distance(stepped.truth[k], certified.truth[k]) / stepped.length,
              stepped.uncertainty + certified.uncertainty)
        << k;
}

}  // namespace
}  // namespace drape::verify::truth_test
