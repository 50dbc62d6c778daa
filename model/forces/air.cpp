#include <cmath>
#include <cstdint>

#include "model/forces/term.hpp"
#include "model/sheet/normals.hpp"
#include "solver/base/threads.hpp"

namespace drape::model {
namespace {

/// Velocity of a particle: its size and direction, and its part p along the normal. Zero has no direction.
struct Wake {
  Eigen::Vector3d N;
  double speed, p;
  Eigen::Vector3d direction;

  Wake(const Configuration& c, int i) : N(c.normals.row(i)), speed(c.v.row(i).norm()), p(c.v.row(i).dot(N)) {
    direction = speed > 0 ? Eigen::Vector3d(c.v.row(i).transpose() / speed) : Eigen::Vector3d::Zero();
  }

  /// ∂(|p| v°)/∂v. At the kinks, where it does not exist: at rest N Nᵀ, which is exact along and across the normal; 0 for
  /// motion along the surface.
  Eigen::Matrix3d by_v() const {
    if (speed == 0) return N * N.transpose();
    const Eigen::Matrix3d turn = (Eigen::Matrix3d::Identity() - direction * direction.transpose()) / speed;
    return sign() * direction * N.transpose() + std::abs(p) * turn;
  }

  /// ∂(|p| v°)/∂N, 0 for motion along the surface.
  Eigen::Matrix3d by_normal() const { return sign() * speed * direction * direction.transpose(); }

 private:
  double sign() const { return (p > 0) - (p < 0); }
};

}  // namespace

/// Resistance of the air: −c |<v, N>| v° [Etzmuß 2002, (2.37)], a force per area. As printed, without the absolute value, it
/// would push half of all sheets along.
std::optional<Term> make_air(const Sheet& sheet) {
  if (sheet.air == 0) return {};
  const Eigen::VectorXd weight = -sheet.air * sheet.grid.cell_areas();

  Term term;
  term.needs_normals = true;
  term.force = [=](const Configuration& c, Vectors& f) {
    base::each_in_parts(base::threads_for(f.rows()), f.rows(), [&](std::int64_t i) {
      const Wake wake(c, static_cast<int>(i));
      f.row(i) += weight[i] * std::abs(wake.p) * wake.direction.transpose();
    });
  };
  term.jacobian = [=, normals = Normals(sheet.grid)](const Configuration& c, const JacobianEntries& entries) {
    if (!entries.exact()) return;  // not symmetric
    for (int i = 0; i < weight.size(); ++i) {
      const Wake wake(c, i);
      entries.add_dv(i, i, weight[i] * wake.by_v());
      const Eigen::Matrix3d by_N = weight[i] * wake.by_normal();
      for (const auto& [j, dN] : normals.derivative(c.x, i)) entries.add_dx(i, j, by_N * dN);
    }
  };
  return term;
}

}  // namespace drape::model
