#include "bench/commands/force_check.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "model/panel_forces.hpp"
#include "model/phases.hpp"
#include "model/sheet/edges.hpp"
#include "solver/base/largest.hpp"
#include "solver/base/noise.hpp"

namespace drape::bench {
namespace {

using solver::Vectors;

constexpr double largest_difference = 1e-6;
constexpr double difference_step = 1e-5;  ///< of the direction, whose components are up to an edge long

double largest_component(const Vectors& a) { return a.cwiseAbs().maxCoeff<Eigen::PropagateNaN>(); }

/// The derivative of a function of one number at 0.
template <class Function>
auto central_difference(const Function& f) {
  return decltype(f(0))((f(difference_step) - f(-difference_step)) / (2 * difference_step));
}

double relative_error(const Vectors& differences, const Vectors& product, double scale) {
  const double wrong = largest_component(differences - product);
  return wrong == 0 ? 0 : wrong / std::max({largest_component(differences), largest_component(product), scale});
}

/// One panel in motion, the directions of derivatives, and the force of one term.
class Differences {
 public:
  explicit Differences(const model::Sheet& sheet, const model::Start& start)
      : grid_(sheet.grid), normals_(sheet.grid), at_(model::start_of(sheet.grid, start)) {
    const auto [weft, warp] = model::shortest_edges(grid_);
    const double l = std::min(weft, warp);
    at_.x += l / 4 * random(1), at_.v += l * random(2);
    dx_ = l * random(3), dv_ = l * random(4);
  }

  ForceCheck check(std::string_view name, const model::Term& term) const {
    const Vectors rest = Vectors::Zero(at_.x.rows(), 3);
    const auto by_x = [&](double s) { return force(term, at_.x + s * dx_, at_.v); };
    const auto by_v = [&](double s) { return force(term, at_.x, at_.v + s * dv_); };
    const double scale = largest_component(by_x(0));
    const auto [df_dx, df_dv] = products(term);
    ForceCheck found{.name = std::string(name),
                     .by_x = relative_error(central_difference(by_x), df_dx, scale),
                     .by_v = relative_error(central_difference(by_v), df_dv, scale)};
    if (!term.energy) return found;
    const Vectors f = force(term, at_.x, rest);
    const double rise = central_difference([&](double s) { return term.energy(at_.x + s * dx_); });
    const double most = f.norm() * dx_.norm();
    found.energy = most > 0 ? std::abs(rise + f.cwiseProduct(dx_).sum()) / most : std::abs(rise);
    return found;
  }

 private:
  Vectors random(unsigned seed) const {
    return Eigen::Map<const Vectors>(base::noise(3 * grid_.particles(), seed).data(), grid_.particles(), 3);
  }

  Vectors normals_at(const model::Term& term, const Vectors& x) const {
    Vectors normals(term.needs_normals ? x.rows() : 0, 3);
    if (term.needs_normals) normals_.evaluate(x, normals);
    return normals;
  }

  Vectors force(const model::Term& term, const Vectors& x, const Vectors& v) const {
    Vectors f = Vectors::Zero(x.rows(), 3);
    if (term.law.acts()) model::FusedForces(grid_, term.law)(x, v, f);
    if (term.force) term.force({0, x, v, normals_at(term, x)}, f);
    return f;
  }

  /// The Jacobians times the directions.
  std::pair<Vectors, Vectors> products(const model::Term& term) const {
    std::pair all(Vectors(Vectors::Zero(dx_.rows(), 3)), Vectors(Vectors::Zero(dx_.rows(), 3)));
    const auto times = [](const Vectors& direction, Vectors& product) {
      return [&](int i, int j, const Eigen::Matrix3d& block) { product.row(i) += direction.row(j) * block.transpose(); };
    };
    if (term.jacobian)
      term.jacobian({0, at_.x, at_.v, normals_at(term, at_.x)},
                    {model::Curvature::exact, times(dx_, all.first), times(dv_, all.second)});
    return all;
  }

  model::Grid grid_;
  model::Normals normals_;
  solver::State at_;
  Vectors dx_, dv_;
};

}  // namespace

bool ForceCheck::agrees() const {
  return by_x <= largest_difference && by_v <= largest_difference && energy.value_or(0) <= largest_difference;
}

std::vector<ForceCheck> check_forces(const model::Scene& scene) {
  std::vector<ForceCheck> all;
  const model::Garment garment(model::phases(scene).front());
  for (const model::Garment::Panel& panel : garment.panels()) {
    const Differences differences(panel.sheet, panel.start);
    const model::PanelForces forces(panel.sheet);
    for (const auto& [name, term] : forces.terms()) {
      if (term.memory) continue;
      const ForceCheck found = differences.check(name, term);
      const auto same = std::ranges::find(all, found.name, &ForceCheck::name);
      if (same == all.end()) {
        all.push_back(found);
        continue;
      }
      same->by_x = base::larger(same->by_x, found.by_x), same->by_v = base::larger(same->by_v, found.by_v);
      if (found.energy) same->energy = base::larger(same->energy.value_or(0), *found.energy);
    }
  }
  return all;
}

}  // namespace drape::bench
