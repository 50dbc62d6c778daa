// A strip of a sheet as a scene of its own: its particles have the place, mass, pins, springs and forces that they have in the
// whole sheet.

#include "bench/strips/share.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"

namespace drape::verify::strip_share_test {
namespace {

using bench::strips::Share;
using bench::strips::shares;
using bench::strips::strip_masses;
using bench::strips::strip_of;
using solver::Vectors;
using testing::HasSubstr;

constexpr double round_off = 1e-12;

/// All forces between neighbours, a start that is turned, and pins of several rules.
model::Scene sheet(std::vector<model::Override> more = {}) {
  std::vector<model::Override> overrides{
      {"grid.n", "[5, 7]"},
      {"grid.size", "[0.4, 0.9]"},
      {"material.shear_damping", "0.1"},
      {"material.contraction", "50"},
      {"start.stretch", "[1.1, 0.9]"},
      {"start.rotation", "[10, 20, 30]"},
      {"start.position", "[1, 2, 3]"},
      {"pins", "[{where = \"left edge\"}, {where = \"upper corners\", directions = \"x\"}]"}};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return model::load_scene("hung-corners", overrides);
}

Vectors wave(Eigen::Index particles, double count) {
  return Vectors::NullaryExpr(particles, 3,
                              [=](Eigen::Index i, Eigen::Index c) { return std::sin(count * double(3 * i + c)); });
}

TEST(Shares, AreAsEqualAsPossibleOrAsAsked) {
  const std::vector<Share> equal = shares(7, 3);
  ASSERT_EQ(equal.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_THAT(equal[k].lines, testing::AnyOf(2, 3));
    EXPECT_EQ(equal[k].first, k == 0 ? 0 : equal[k - 1].first + equal[k - 1].lines);
    EXPECT_EQ(equal[k].before, k > 0);
    EXPECT_EQ(equal[k].behind, k < 2);
  }
  EXPECT_EQ(equal[2].first + equal[2].lines, 7);
  EXPECT_EQ(shares(7, 3, {1, 5, 1})[1].lines, 5);
  const auto refused = [](int processes, const std::vector<int>& lines) { shares(7, processes, lines); };
  EXPECT_THAT([&] { refused(8, {}); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("expected at most 7 processes for 7 lines, not 8")));
  for (const std::vector<int>& lines : {std::vector{3, 4}, {3, 4, 1}, {7, 0, 0}, {8, 1, -2}})
    EXPECT_THAT([&] { refused(3, lines); },
                testing::ThrowsMessage<std::invalid_argument>(HasSubstr("lines: expected 3 positive numbers")));
}

class StripOf : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(ASheetWithBorders, StripOf, testing::Values("dual", "whole"),
                         [](const auto& test) { return test.param; });

TEST_P(StripOf, HasTheParticlesSpringsAndForcesOfTheSheet) {
  const model::Scene scene = sheet({{"grid.border_cells", GetParam()}});
  const model::Cloth whole = model::compile(scene);
  const int columns = scene.sheet.grid.nu;
  const Vectors x = whole.start.x + 0.01 * wave(whole.start.x.rows(), 1.7), v = wave(x.rows(), 2.3);
  Vectors force(x.rows(), 3);
  whole.ode.force(0, x, v, force);
  for (const Share& share : shares(scene.sheet.grid.nv, 4, {1, 3, 2, 1})) {
    const model::Cloth strip = model::compile(strip_of(scene, share));
    const Eigen::Index copied = columns * share.copied_first(), all = columns * share.copied_lines();
    const Eigen::Index first = columns * share.first, rows = columns * share.lines;
    ASSERT_EQ(strip.ode.particles(), all);
    EXPECT_LT((strip.start.x - whole.start.x.middleRows(copied, all)).norm(), round_off);
    EXPECT_LT((strip_masses(scene, share, strip.ode.mass) - whole.ode.mass.segment(copied, all)).norm(), round_off);
    Vectors own(all, 3);
    strip.ode.force(0, x.middleRows(copied, all), v.middleRows(copied, all), own);
    EXPECT_LT((own.middleRows(first - copied, rows) - force.middleRows(first, rows)).norm(), round_off * force.norm());
    for (const auto matrix : {&solver::SplitOde::stiffness, &solver::SplitOde::damping}) {
      const Eigen::MatrixXd of_strip(strip.ode.*matrix), of_whole(whole.ode.*matrix);
      EXPECT_LT((of_strip.middleRows(first - copied, rows) - of_whole.block(first, copied, rows, all)).norm(),
                round_off * of_whole.norm());
    }
  }
}

TEST(Strips, HaveThePinsOfTheirLines) {
  const model::Scene scene = sheet();
  const model::Cloth whole = model::compile(scene);
  std::size_t own_pins = 0;
  for (const Share& share : shares(7, 3)) {
    const model::Cloth strip = model::compile(strip_of(scene, share));
    for (const solver::Pin& pin : strip.ode.pins) {
      const int particle = pin.particle + 5 * share.copied_first();
      const auto same = std::ranges::find(whole.ode.pins, particle, &solver::Pin::particle);
      ASSERT_NE(same, whole.ode.pins.end());
      EXPECT_EQ(pin.held, same->held);
      const int line = particle / 5;
      own_pins += line >= share.first && line < share.first + share.lines;
    }
  }
  EXPECT_EQ(own_pins, whole.ode.pins.size());
}

TEST(Strips, AreRefusedWhereOneLineBesideIsNotEnough) {
  const auto refusal = [](std::vector<model::Override> more) {
    try {
      strip_of(sheet(std::move(more)), shares(7, 2)[0]);
      return std::string();
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(refusal({}), "");
  EXPECT_THAT(refusal({{"material.bend", "1e-3"}}), HasSubstr("it has the force plate"));
  EXPECT_THAT(refusal({{"forces.air", "1"}}), HasSubstr("it has the force air"));
  EXPECT_THAT(refusal({{"grid.grading", "[1, 2]"}}), HasSubstr("its grid is not uniform"));
  EXPECT_THAT(refusal({{"contact.thickness", "1e-3"}}), HasSubstr("it has obstacles or contact"));
}

}  // namespace
}  // namespace drape::verify::strip_share_test
