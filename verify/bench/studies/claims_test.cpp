// The ledger of claims: what numbers come to, and that each claim could have come out otherwise.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/studies/claims/claim.hpp"
#include "results/file/run_file.hpp"
#include "verify/support/bench_integrators.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::claims_test {
namespace {

using bench::Claim;
using bench::ClaimCase;
using bench::Holds;
using bench::judge;
using bench::unbounded;
using results::Standing;
using results::Verdict;

ClaimCase between_1_and_2(double value, double uncertainty, std::string where = "") {
  return {std::move(where), value, uncertainty, 1, 2};
}

TEST(ClaimCase, IsConfirmedOnlyWhereAllThatItMayBeIsBetweenTheBounds) {
  EXPECT_EQ(judge(between_1_and_2(1.5, 0.4)), Holds::confirmed);
  EXPECT_EQ(judge(between_1_and_2(1.5, 0.6)), Holds::undecided);
  EXPECT_EQ(judge(between_1_and_2(0.95, 0.1)), Holds::undecided);
  EXPECT_EQ(judge(between_1_and_2(0.5, 0.4)), Holds::refuted) << "below";
  EXPECT_EQ(judge(between_1_and_2(2.5, 0.4)), Holds::refuted) << "above";
}

TEST(ClaimCase, IsUndecidedWhereNothingWasMeasured) {
  EXPECT_EQ(judge(between_1_and_2(NAN, 0)), Holds::undecided);
  EXPECT_EQ(judge(between_1_and_2(1.5, NAN)), Holds::undecided);
}

TEST(ClaimVerdict, SaysWhereAClaimHolds) {
  const ClaimCase yes = between_1_and_2(1.5, 0, "d = 50"), no = between_1_and_2(3, 0, "d = 5"),
                  open = between_1_and_2(2, 1, "d = 0");
  const auto verdict = [](const std::vector<ClaimCase>& cases) { return judge(cases); };
  EXPECT_EQ(verdict({yes, yes}), (Verdict{Standing::met, "confirmed"}));
  EXPECT_EQ(verdict({no, no}), (Verdict{Standing::missed, "refuted"}));
  EXPECT_EQ(verdict({no, yes}), (Verdict{Standing::open, "only if d = 50"}));
  EXPECT_EQ(verdict({yes, open, yes}), (Verdict{Standing::open, "only if d = 50, d = 50"}));
  EXPECT_EQ(verdict({no, open}), (Verdict{Standing::open, "undecided"}));
  EXPECT_EQ(verdict({}), (Verdict{Standing::open, "undecided"}));
}

TEST(ClaimVerdict, IsDecidedByWhatRefutes) {
  const std::vector<ClaimCase> cases{between_1_and_2(1.5, 0, "yes"), between_1_and_2(2, 1, "open"),
                                     between_1_and_2(3, 0, "no")};
  EXPECT_EQ(bench::deciding(cases).where, "no");
  EXPECT_EQ(bench::deciding(std::span(cases).first(2)).where, "open");
  EXPECT_EQ(bench::deciding(std::span(cases).first(1)).where, "yes");
}

TEST(Ledger, NamesEachClaimOnceWithItsSource) {
  std::set<std::string_view> ids;
  for (const Claim* claim : bench::all_claims()) {
    EXPECT_TRUE(ids.insert(claim->id).second) << claim->id << " is there twice";
    for (const std::string_view text : {claim->source, claim->claim, claim->measured, claim->unit, claim->command})
      EXPECT_FALSE(text.empty()) << claim->id;
  }
  EXPECT_GE(ids.size(), 54U);
}

/// The same measurement with a number beyond its bounds.
std::vector<ClaimCase> beyond(ClaimCase one) {
  std::vector<ClaimCase> all;
  one.uncertainty = std::isnan(one.uncertainty) ? 0 : one.uncertainty;
  const double far = 1 + 2 * one.uncertainty;
  for (const double value : {one.lower - far, one.upper + far})
    if (std::isfinite(value)) all.push_back({one.where, value, one.uncertainty, one.lower, one.upper});
  return all;
}

/// What a claim was measured as, once for all tests.
const std::vector<ClaimCase>& measured(const Claim& claim) {
  static std::map<std::string_view, std::vector<ClaimCase>> all;
  const auto found = all.find(claim.id);
  return found != all.end() ? found->second : all.emplace(claim.id, claim.measure()).first->second;
}

/// A claim has a number and a bound, so that another number would have refuted it.
void expect_refutable(const Claim& claim, const std::vector<ClaimCase>& cases) {
  ASSERT_FALSE(cases.empty()) << claim.id;
  for (const ClaimCase& one : cases) {
    EXPECT_TRUE(std::isfinite(one.value)) << claim.id << ", " << one.where;
    if (!claim.timed) {
      EXPECT_NE(judge(one), Holds::undecided) << claim.id << ", " << one.where << ": " << one.value << " ± " << one.uncertainty;
    }
    EXPECT_FALSE(beyond(one).empty()) << claim.id << ", " << one.where << " could not be refuted";
    for (const ClaimCase& other : beyond(one)) EXPECT_EQ(judge(other), Holds::refuted) << claim.id << ", " << one.where;
  }
}

void expect_refutable(std::span<const Claim> claims) {
  for (const Claim& claim : claims) expect_refutable(claim, measured(claim));
}

TEST(Ledger, OfForcesIsDecidedByNumbersThatCouldHaveRefutedIt) { expect_refutable(bench::force_claims()); }
TEST(Ledger, OfModesIsDecidedByNumbersThatCouldHaveRefutedIt) { expect_refutable(bench::mode_claims()); }
TEST(Ledger, OfPanelsIsDecidedByNumbersThatCouldHaveRefutedIt) { expect_refutable(bench::panel_claims()); }

/// What a measured claim comes to.
std::string verdict_on(std::string_view id) {
  for (const Claim* claim : bench::all_claims())
    if (claim->id == id) return to_string(judge(measured(*claim)));
  return "no such claim";
}

TEST(Ledger, TellsMethodsApartByTheirModes) {
  EXPECT_EQ(verdict_on("C-12"), "only if explicit-euler, explicit-midpoint") << "Verlet and the classical method do not grow";
  EXPECT_EQ(verdict_on("E-23"), "only if implicit-euler, bdf2, tr-bdf2, esdirk4") << "the midpoint rule does not damp";
  EXPECT_EQ(verdict_on("C-11"), "met: confirmed");
  EXPECT_THAT(verdict_on("C-07"), testing::StartsWith("only if ω² = κ (imex-euler)"));
}

TEST(Ledger, FindsThatASaddleNeedsTwist) {
  EXPECT_EQ(verdict_on("C-21"), "only if slanted cylinder");
  EXPECT_EQ(verdict_on("C-23b"), "met: confirmed");
}

TEST(Ledger, FindsWhatPrintedAlgorithmsLackOnBordersAndBesideThem) {
  EXPECT_EQ(verdict_on("P-03"), "only if inside, borders, as here");
  EXPECT_EQ(verdict_on("P-05"), "only if in cells, as here");
}

TEST(Ledger, FindsThatAlphaMethodsLoseWhatIsPrescribed) {
  for (const char* id : {"F-17", "F-17b"}) EXPECT_EQ(verdict_on(id), "met: confirmed") << id;
}

/// The numbers of a claim in the table of cases.
std::vector<ClaimCase> recorded(const results::Table& table, const Claim& claim) {
  const auto number = [&](std::size_t row, const char* column) { return number_in(find_column(table, column), row); };
  const auto bound = [&](std::size_t row, const char* column, double none) {
    return std::isnan(number(row, column)) ? none : number(row, column);
  };
  std::vector<ClaimCase> cases;
  for (std::size_t row = 0; row < rows(table); ++row)
    if (text_in(find_column(table, "id"), row) == claim.id)
      cases.push_back({text_in(find_column(table, "where"), row), number(row, claim.timed ? "time_value" : "value"),
                       number(row, claim.timed ? "time_uncertainty" : "uncertainty"), bound(row, "lower", -unbounded),
                       bound(row, "upper", unbounded)});
  return cases;
}

/// One test, since the study takes a minute and tests may run in processes of their own.
TEST(Ledger, OfItsStudyIsDecidedByNumbersThatCouldHaveRefutedItAndFindsWhatTheLiteratureSays) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  program.output({"study", "claims", "--out", "claims.h5"});
  const auto tables = results::read_tables(program.folder() / "claims.h5");
  ASSERT_THAT(tables, testing::SizeIs(2));

  std::map<std::string_view, std::string> verdicts;
  const std::vector<const Claim*> claims = bench::all_claims();
  ASSERT_EQ(rows(tables[0]), claims.size());
  for (std::size_t row = 0; row < claims.size(); ++row) {
    const Claim& claim = *claims[row];
    const std::vector<ClaimCase> cases = recorded(tables[1], claim);
    expect_refutable(claim, cases);
    verdicts[claim.id] = text_in(find_column(tables[0], "verdict"), row);
    EXPECT_EQ(text_in(find_column(tables[0], "id"), row), claim.id);
    EXPECT_EQ(verdicts[claim.id], to_string(judge(cases))) << claim.id;
  }

  for (const char* id : {"C-15", "C-17", "F-10", "F-11", "F-13", "F-14", "F-18", "F-19", "F-20"})
    EXPECT_EQ(verdicts[id], "met: confirmed") << id;
  EXPECT_THAT(verdicts, testing::Contains(testing::Pair(testing::_, "missed: refuted"))) << "some are";
  EXPECT_EQ(verdicts["F-15"], "only if d = 0.5, to 0.1 of |b|, d = 0.5, to 0.01 of |b|") << "vertex block descent";
  EXPECT_EQ(verdicts["F-16"], "only if d = 50, d = 5") << "exponential steps are long where damping limits Verlet";
  EXPECT_EQ(verdicts["C-05"], "only if also explicit forces of velocities") << "one pass is of order one only then";
  EXPECT_EQ(verdicts["C-27"], "only if d = 5, d = 0.5") << "control by passes saves them with little damping";
  EXPECT_EQ(verdicts["C-32"], "only if bdf2, midpoint") << "contact shortens steps of methods of second order";
}

}  // namespace
}  // namespace drape::verify::claims_test
