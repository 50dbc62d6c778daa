// The modes of a pinned sheet in closed form are eigenvectors of what the compiled model makes of it.

#include "reference/exact/modes.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/cloth.hpp"
#include "verify/support/pinned_sheet.hpp"

namespace drape::verify::modes_test {
namespace {

using reference::LinearMode;
using reference::Motion;
using reference::PinnedSheet;
using reference::SheetMode;
using solver::SparseMatrix;
using solver::Vectors;

struct Case {
  std::string name;
  PinnedSheet sheet;
  double shear = 0;
  bool in_plane = true;  ///< whether its in-plane modes are known

  model::Cloth cloth() const {
    model::Scene scene = scene_of(sheet);
    scene.sheet.material.shear = shear;
    return model::compile(scene);
  }
};

std::vector<Case> cases() {
  PinnedSheet damped = tense_sheet(), plate = tense_sheet(), contracting;
  damped.d1 = 0.7, damped.d2 = 0.4;
  plate.B1 = 0.06, plate.B2 = 0.04, plate.dB1 = 0.01, plate.dB2 = 0.02;
  contracting = damped;
  contracting.contraction = 11;
  PinnedSheet unprojected = plate;
  unprojected.plate_projected = false;
  return {{"tension", tense_sheet()},
          {"damped", damped},
          {"projected_plate", plate},
          {"unprojected_plate", unprojected},
          {"contraction_and_shear", contracting, 1.5, false}};
}

/// Calls visit(mode) for all modes of a sheet that are known.
template <class Visit>
void for_each_mode(const Case& c, const Visit& visit) {
  for (const Motion motion : {Motion::along_u, Motion::along_v, Motion::transverse})
    for (int m = 1; m <= c.sheet.nu - 2; ++m)
      for (int n = 1; n <= c.sheet.nv - 2; ++n)
        if (c.in_plane || motion == Motion::transverse) visit(SheetMode{m, n, motion});
}

/// Largest component of J z + λ M z over the free particles, relative to the largest entry of J.
double left_over(const SparseMatrix& J, double lambda, const solver::SplitOde& ode, const Vectors& z) {
  Vectors r = lambda * (ode.mass.asDiagonal() * z);
  Eigen::Map<Eigen::VectorXd>(r.data(), r.size()) += J * Eigen::Map<const Eigen::VectorXd>(z.data(), z.size());
  filter(ode.pins, r);
  const double size = J.nonZeros() > 0 ? J.coeffs().abs().maxCoeff() : 1;
  return r.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / size;
}

/// The three matrices of a compiled sheet at its start, each with what a mode says its eigenvalue is: the worst left_over().
double worst(const model::Cloth& cloth, const LinearMode& mode, const Vectors& shape) {
  const solver::SplitOde& ode = cloth.ode;
  SparseMatrix df_dx, df_dv;
  ode.jacobian(0, cloth.start.x, cloth.start.v, df_dx, df_dv);
  Vectors r = ode.stiffness * shape + mode.kappa * (ode.mass.asDiagonal() * shape);
  filter(ode.pins, r);
  return std::max({left_over(df_dx, mode.omega_squared, ode, shape), left_over(df_dv, mode.damping, ode, shape),
                   r.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / ode.stiffness.coeffs().abs().maxCoeff()});
}

constexpr double round_off = 20 * std::numeric_limits<double>::epsilon();

TEST(Modes, AreEigenvectorsOfTheCompiledModel) {
  for (const Case& c : cases()) {
    const model::Cloth cloth = c.cloth();
    for_each_mode(c, [&](const SheetMode& mode) {
      EXPECT_LE(worst(cloth, linear_mode(c.sheet, mode), mode_shape(c.sheet, mode)), round_off)
          << c.name << ", " << mode.m << " x " << mode.n << ", motion " << static_cast<int>(mode.motion);
    });
  }
}

TEST(Modes, AreForcelessAtTheirCentre) {
  for (const Case& c : cases()) {
    const model::Cloth cloth = c.cloth();
    Vectors f(cloth.start.x.rows(), 3);
    cloth.ode.force(0, cloth.start.x, cloth.start.v, f);
    filter(cloth.ode.pins, f);
    EXPECT_LE(f.cwiseAbs().maxCoeff<Eigen::PropagateNaN>(), 1e-13) << c.name;
  }
}

TEST(Modes, AreNotThoseOfAnotherSheet) {
  for (const auto& change :
       {+[](PinnedSheet& s) { std::swap(s.k1, s.k2); }, +[](PinnedSheet& s) { std::swap(s.B1, s.B2); },
        +[](PinnedSheet& s) { std::swap(s.dB1, s.dB2); }, +[](PinnedSheet& s) { std::swap(s.strain_u, s.strain_v); },
        +[](PinnedSheet& s) { s.plate_projected = !s.plate_projected; }}) {
    const Case truth = cases()[3];
    PinnedSheet other = truth.sheet;
    change(other);
    double difference = 0;
    for_each_mode(truth, [&](const SheetMode& mode) {
      difference = std::max(difference, worst(truth.cloth(), linear_mode(other, mode), mode_shape(other, mode)));
    });
    EXPECT_GE(difference, 1e-3);
  }
}

TEST(Modes, ThatDoNotExistAreRefused) {
  const PinnedSheet sheet = tense_sheet();
  for (const SheetMode& mode : {SheetMode{0, 1}, {1, 0}, {sheet.nu - 1, 1}, {1, sheet.nv - 1}}) {
    EXPECT_THROW(linear_mode(sheet, mode), std::invalid_argument);
    EXPECT_THROW(mode_shape(sheet, mode), std::invalid_argument);
  }
  PinnedSheet contracting = sheet;
  contracting.contraction = 1;
  EXPECT_THROW(linear_mode(contracting, {1, 1, Motion::along_v}), std::invalid_argument);
}

}  // namespace
}  // namespace drape::verify::modes_test
