#include "reference/exact/modes.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace drape::reference {
namespace {

/// Eigenvalue of the second difference −D² on n particles over the length L for m half waves [1/m²].
double eigenvalue(int m, int n, double L) {
  const double l = L / (n - 1), s = std::sin(std::numbers::pi * m / (2 * (n - 1)));
  return 4 / (l * l) * s * s;
}

void check(const PinnedSheet& sheet, const SheetMode& mode) {
  if (mode.m < 1 || mode.m > sheet.nu - 2 || mode.n < 1 || mode.n > sheet.nv - 2)
    throw std::invalid_argument("a pinned sheet has modes with 1 to nu - 2 half waves along u and 1 to nv - 2 along v");
  if (mode.motion != Motion::transverse && sheet.contraction != 0)
    throw std::invalid_argument("in-plane modes are known without transverse contraction only: contraction must be 0");
}

}  // namespace

LinearMode linear_mode(const PinnedSheet& sheet, const SheetMode& mode) {
  check(sheet, mode);
  const auto& [nu, nv, Lu, Lv, eu, ev, rho, k1, k2, C12, d1, d2, B1, B2, dB1, dB2, projected] = sheet;
  const double lambda_u = eigenvalue(mode.m, nu, Lu), lambda_v = eigenvalue(mode.n, nv, Lv);
  const bool transverse = mode.motion == Motion::transverse;
  const double plate = transverse || !projected ? lambda_u + lambda_v : 0;
  const double along_u = mode.motion == Motion::along_u ? k1 : (k1 * eu + C12 * ev) / (1 + eu);
  const double along_v = mode.motion == Motion::along_v ? k2 : (k2 * ev + C12 * eu) / (1 + ev);
  return {.kappa = (k1 * lambda_u + k2 * lambda_v) / rho,
          .omega_squared = ((along_u + B1 * plate) * lambda_u + (along_v + B2 * plate) * lambda_v) / rho,
          .damping = ((d1 + dB1 * plate) * lambda_u + (d2 + dB2 * plate) * lambda_v) / rho};
}

solver::Vectors mode_shape(const PinnedSheet& sheet, const SheetMode& mode) {
  check(sheet, mode);
  const auto half_waves = [](int count, int particles) -> Eigen::VectorXd {
    return Eigen::ArrayXd::LinSpaced(particles, 0, std::numbers::pi * count).sin();
  };
  const Eigen::MatrixXd shape = half_waves(mode.m, sheet.nu) * half_waves(mode.n, sheet.nv).transpose();
  solver::Vectors x = solver::Vectors::Zero(shape.size(), 3);
  x.col(static_cast<int>(mode.motion)) = shape.reshaped();
  return x;
}

}  // namespace drape::reference
