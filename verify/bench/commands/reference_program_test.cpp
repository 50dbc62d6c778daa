// What bench_integrators does while a reference is computed, and with those it has kept.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "verify/support/bench_integrators.hpp"

namespace drape::verify::reference_program_test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::SizeIs;

TEST(ProgramReference, IsBoundedByTheTimeLimitAndSaysHowFarItIsAfterTheTimesOfTheRuns) {
  const BenchIntegrators program;
  const ProgramResult result =
      program.run({"run", "--scene", "hung-corners", "--set", "grid.n=40", "--set", "material.damping=0.1", "--until", "4",
                   "--method", "imex-euler", "--step", "0.1", "--repeat", "1", "--time-limit", "5", "--format", "csv"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::vector<Row> rows = parse_csv(result.out);
  ASSERT_THAT(rows, SizeIs(1));
  EXPECT_EQ(rows[0].at("outcome"), "success");
  EXPECT_EQ(rows[0].at("message"), "no reference: out of time: longer than 5 s");
  EXPECT_GT(number(rows[0], "wall_ms_median"), 0);
  EXPECT_THAT(result.err,
              ContainsRegex("^hung-corners imex-euler h = 0.1: success, [0-9.]+ ms; its error follows\n"
                            "reference of hung-corners: trajectory at t = [0-9.]+ s, witness at t = [0-9.]+ s of 4 s, "));
  EXPECT_THAT(lines(result.err), SizeIs(3)) << "a line every five seconds, and one at the end";
  EXPECT_THAT(lines(result.err).back(), ContainsRegex("^reference of hung-corners: ended after [5-9] s$"));
}

TEST(ProgramReference, IsAsTightAsTheSmallestErrorNeedsAndServesLargerOnes) {
  const BenchIntegrators program;
  const auto kept = [&] { return std::distance(std::filesystem::directory_iterator(program.cache()), {}); };
  const auto run = [&](const Words& method) {
    const Words tiny{"run", "--scene", "hung-edge", "--set", "grid.n=5", "--until", "0.05", "--repeat", "1", "--format", "csv"};
    return parse_csv(program.output(tiny + method)).at(0);
  };
  const Words coarse{"--method", "bdf2", "--step", "0.01"}, fine{"--method", "esdirk4", "--step", "0.01"};
  const double loose = number(run(coarse), "reference_error");
  EXPECT_EQ(kept(), 1);
  const Row exact = run(fine);
  EXPECT_LE(10 * number(exact, "reference_error"), number(exact, "error_rms"));
  EXPECT_EQ(kept(), 2);
  EXPECT_LT(number(run(coarse), "reference_error"), loose / 2);
  EXPECT_EQ(kept(), 2);
}

}  // namespace
}  // namespace drape::verify::reference_program_test
