#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>

#include "bench/studies/studies.hpp"
#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/exact/bending.hpp"
#include "reference/exact/shear.hpp"
#include "reference/exact/tension.hpp"
#include "reference/sundials/kinsol.hpp"
#include "results/analysis/order_fit.hpp"
#include "results/verdict.hpp"
#include "solver/base/statistics.hpp"

namespace drape::bench {
namespace {

using model::Override;
using solver::Vectors;

/// One line of figure 2.11: a scene, the form of its forces, and where its particles should come to rest.
struct Experiment {
  std::string scene, name, form;
  double order;  ///< declared; 0: exact at the nodes; NaN: none
  std::vector<Override> overrides;
  bool strip;  ///< all is constant across: three lines of the sheet are enough
  int still;   ///< the coordinate in which nothing moves
  int finest = 160;
  std::function<Eigen::Vector3d(double u, double v)> exact;
  double uncertainty = 0;  ///< of the exact solution [m]
};

const std::vector<Override> as_printed{{"grid.border_cells", "whole"}};

std::vector<Override> operator+(std::vector<Override> a, const std::vector<Override>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// (a): the fixed edge is at the right.
std::vector<Experiment> tension() {
  const auto exact = [](double u, double v) { return Eigen::Vector3d(1 - reference::pulled_position({}, 1 - u), v, 0); };
  const auto still = 2;
  return {{.scene = "tension",
           .name = "tension",
           .form = "consistent",
           .order = 0,
           .overrides = {},
           .strip = true,
           .still = still,
           .exact = exact},
          {.scene = "tension",
           .name = "tension",
           .form = "printed",
           .order = 1,
           .overrides = as_printed,
           .strip = true,
           .still = still,
           .exact = exact}};
}

/// (b): with k = 10⁹ no mesh resolves the layers along the free edges, and with f = 10 and k from 10³ on the compressed fibres
/// buckle; so f = 1 and k = 100 for the order, and f = 10, k = 10⁹ beside the inextensible limit for the thesis' picture.
std::vector<Experiment> shear() {
  const auto sheet = std::make_shared<const reference::ShearedSheet>(
      reference::SideloadedSheet{.side = 1, .modulus = 100, .shear = 100, .body_force = 1});
  const auto exact = [sheet](double u, double v) -> Eigen::Vector3d {
    return ((*sheet)(u, v).homogeneous() - Eigen::Vector3d::UnitZ());
  };
  const auto limit = [](double u, double v) -> Eigen::Vector3d {
    return reference::inextensible_position({}, u, v).homogeneous() - Eigen::Vector3d::UnitZ();
  };
  const std::vector<Override> printed{{"material.shear_form", "printed"}};
  const std::vector<Override> thesis{{"material.tension", "1e9"}, {"forces.gravity", "[0, 10, 0]"}};
  const double none = std::numeric_limits<double>::quiet_NaN();
  return {{.scene = "shear",
           .name = "shear",
           .form = "consistent",
           .order = 2,
           .overrides = {},
           .strip = false,
           .still = 2,
           .exact = exact,
           .uncertainty = sheet->error()},
          {.scene = "shear",
           .name = "shear",
           .form = "printed",
           .order = none,
           .overrides = as_printed + printed,
           .strip = false,
           .still = 2,
           .exact = exact,
           .uncertainty = sheet->error()},
          {.scene = "shear",
           .name = "shear, f = 10, k = 1e9",
           .form = "consistent",
           .order = none,
           .overrides = thesis,
           .strip = false,
           .still = 2,
           .finest = 40,
           .exact = limit},
          {.scene = "shear",
           .name = "shear, f = 10, k = 1e9",
           .form = "printed",
           .order = none,
           .overrides = thesis + as_printed + printed,
           .strip = false,
           .still = 2,
           .finest = 40,
           .exact = limit}};
}

Experiment bending(double B, reference::BendingForce force, const std::string& form, double order,
                   std::vector<Override> overrides) {
  const auto strip = std::make_shared<const reference::BentStrip>(reference::BentSheet{.bend = B, .force = force});
  const auto exact = [strip](double u, double v) {
    const Eigen::Vector2d xz = (*strip)(u);
    return Eigen::Vector3d(xz[0], v, xz[1]);
  };
  overrides.push_back({"material.bend", fmt::format("{}", B)});
  return {.scene = "bending",
          .name = fmt::format("bending, B = {:g}", B),
          .form = form,
          .order = order,
          .overrides = overrides,
          .strip = true,
          .still = 1,
          .exact = exact,
          .uncertainty = strip->error()};
}

/// (c), and with large deflections.
std::vector<Experiment> bending() {
  using enum reference::BendingForce;
  const double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<Experiment> all{
      bending(5, along_normal, "consistent", 2, {}),
      bending(5, along_normal, "printed", none, as_printed + std::vector<Override>{{"material.bend_form", "printed"}}),
      bending(5, along_normal, "printed, is_border", none,
              as_printed + std::vector<Override>{{"material.bend_form", "printed-is-border"}})};
  for (const double B : {0.01, 0.005}) {
    all.push_back(bending(B, along_normal, "consistent", 2, {}));
    all.push_back(bending(B, whole, "unprojected", 2, {{"material.bend_projected", "false"}}));
  }
  return all;
}

model::Scene scene_of(const Experiment& experiment, int n) {
  std::vector<Override> overrides = experiment.overrides;
  overrides.push_back({"grid.n", experiment.strip ? fmt::format("[{}, 3]", n) : std::to_string(n)});
  if (experiment.strip) overrides.push_back({"grid.size", fmt::format("[1, {}]", 2.0 / (n - 1))});
  return model::load_scene(experiment.scene, overrides);
}

/// Pins one coordinate of all particles.
void hold_still(std::vector<solver::Pin>& pins, int particles, int coordinate) {
  std::vector<solver::Pin> all(static_cast<std::size_t>(particles));
  for (int i = 0; i < particles; ++i) all[i] = {.particle = i, .held = Eigen::Matrix3d::Zero()};
  for (const solver::Pin& pin : pins) all[pin.particle] = pin;
  for (solver::Pin& pin : all) pin.held(coordinate, coordinate) = 1;
  pins = std::move(all);
}

/// Distances [m] of the equilibrium from the exact one.
struct Errors {
  std::optional<double> rms = {}, maximum = {};  ///< the mean weighted with dual cells: the L2 norm
  std::optional<double> residual = {};           ///< [N]
  std::optional<std::string> remark = {};        ///< why the number is missing
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Errors, rms, maximum, residual, remark)

Errors find_errors(const Experiment& experiment, int n) {
  const model::Scene scene = scene_of(experiment, n);
  model::Cloth cloth = model::compile(scene);
  hold_still(cloth.ode.pins, cloth.ode.particles(), experiment.still);
  const model::Grid& grid = scene.sheet.grid;
  const Vectors uv = grid.parameters();
  Vectors exact(uv.rows(), 3);
  for (Eigen::Index i = 0; i < uv.rows(); ++i) exact.row(i) = experiment.exact(uv(i, 0), uv(i, 1)).transpose();
  const Vectors guess = exact + 0.01 * (exact - uv);  // near, but not there: it has to be found
  const reference::Equilibrium found = reference::equilibrium(cloth.ode, guess, {.line_search = false});
  const Eigen::VectorXd squares = (found.x - exact).rowwise().squaredNorm();
  double sum = 0, area = 0;
  for (int i = 0; i < grid.particles(); ++i) {
    const double weight = model::Grid::dual_width(i % grid.nu, grid.nu) * model::Grid::dual_width(i / grid.nu, grid.nv);
    sum += weight * squares[i];
    area += weight;
  }
  return {std::sqrt(sum / area), std::sqrt(squares.maxCoeff()), found.residual};
}

Errors errors(const Experiment& experiment, int n) {
  try {
    return find_errors(experiment, n);
  } catch (const reference::ReferenceError& error) {
    return {.remark = error.what()};
  }
}

/// The verdict on a curve; nothing if nothing is declared and an order is to be seen.
std::optional<results::Verdict> conclusion(const Experiment& experiment, const std::optional<results::OrderFit>& fit,
                                           double finest_error) {
  constexpr double round_off = 1e-10;
  if (experiment.order == 0) return results::check(finest_error <= round_off, "exact as declared", "not exact");
  if (std::isnan(experiment.order) && fit) return std::nullopt;
  return results::order_verdict(fit, experiment.order);
}

/// An experiment at one resolution.
struct Equilibrium {
  std::string experiment, form;
  int n;
  Errors errors;
  std::optional<double> order;
  double uncertainty;
  std::optional<results::FittedCurve> curve;  ///< of all resolutions, with the first
};

template <auto member>
constexpr auto of_errors = [](const Equilibrium& row) { return results::to_datum(row.errors.*member); };

using results::Role;
constexpr results::ColumnOf<Equilibrium> equilibrium_columns[] = {
    {"experiment", "experiment", "", "which, with what differs from the scene of that name", Role::key,
     results::field<&Equilibrium::experiment>},
    {"form", "form", "", "of the forces: consistent, or as the algorithms of the thesis print them", Role::key,
     results::field<&Equilibrium::form>},
    {"n", "n", "1", "particles in one direction", Role::key, results::field<&Equilibrium::n>},
    {"rms", "rms error", "m", "root mean square distance of the nodes from the exact equilibrium (L2)", Role::error,
     of_errors<&Errors::rms>},
    {"maximum", "maximum", "m", "largest distance", Role::error, of_errors<&Errors::maximum>},
    {"order", "order", "1", "between this resolution and the one before, of the rms error", Role::note,
     results::field<&Equilibrium::order>},
    {"residual", "", "N", "largest force that was left", Role::note, of_errors<&Errors::residual>},
    {"remark", "remark", "", "why the number is missing", Role::note, of_errors<&Errors::remark>},
    {"uncertainty", "", "m", "of the exact solution", Role::uncertainty, results::field<&Equilibrium::uncertainty>},
};

/// The curve of one experiment, and its order.
std::vector<Equilibrium> curve(const Experiment& experiment, const std::vector<int>& resolutions, Checkpoint& checkpoint) {
  std::vector<Equilibrium> all;
  std::vector<double> spacings, rms;
  checkpoint.each(resolutions, [&](const int n) {
    checkpoint.show(fmt::format("{}, {}, {} × {}", experiment.name, experiment.form, n, n));
    Equilibrium& row = all.emplace_back(Equilibrium{experiment.name, experiment.form, n, {}, {}, experiment.uncertainty, {}});
    if (n <= experiment.finest)
      row.errors =
          checkpoint.once(fmt::format("{} {} {}", experiment.name, experiment.form, n), [&] { return errors(experiment, n); });
    if (row.errors.rms) {
      if (!rms.empty()) row.order = base::exponent(spacings.back(), rms.back(), 1.0 / (n - 1), *row.errors.rms);
      rms.push_back(*row.errors.rms);
      spacings.push_back(1.0 / (n - 1));
    }
    checkpoint.advance();
  });
  const auto fit = results::fit_order(spacings, rms, experiment.uncertainty);
  all.front().curve = {fit, conclusion(experiment, fit, rms.empty() ? NAN : rms.back())};
  return all;
}

std::vector<Equilibrium> equilibrium_curves(const std::vector<Experiment>& experiments, const std::vector<int>& resolutions,
                                            Checkpoint& checkpoint) {
  std::vector<Equilibrium> rows;
  checkpoint.each(experiments, [&](const Experiment& experiment) {
    std::ranges::move(curve(experiment, resolutions, checkpoint), std::back_inserter(rows));
  });
  return rows;
}

results::Table equilibrium_table(const char* name, const char* title, const std::vector<Equilibrium>& rows) {
  results::Table table = results::make_table(name, title, equilibrium_columns, rows);
  results::add_columns(table, results::fit_columns, rows, std::mem_fn(&Equilibrium::curve));
  using results::Part;
  draw(table, results::Figure::convergence,
       {{Part::figure, "experiment"}, {Part::curve, "form"}, {Part::x, "n"}, {Part::y, "rms"}, {Part::detail, "order"}});
  return table;
}

}  // namespace

std::vector<Job> convergence(const Question& question) {
  const std::vector<int> resolutions = question.quick ? std::vector{20, 28, 36, 48} : std::vector{5, 10, 20, 40, 80, 160};
  const auto figure = [&](const char* name, const char* title, int experiments, auto make) {
    const auto compute = [=](Checkpoint& checkpoint) {
      checkpoint.show(fmt::format("exact solution of {}", name));
      return equilibrium_curves(make(), resolutions, checkpoint);
    };
    const auto present = [=](const auto& rows) { return equilibrium_table(name, title, rows); };
    return job(name, experiments * static_cast<int>(resolutions.size()), compute, present);
  };
  return {figure("figure-2.11a", "Figure 2.11 (a), tension: error of the equilibrium against the resolution", 2, tension),
          figure("figure-2.11b", "Figure 2.11 (b), shear: error of the equilibrium against the resolution", 4, shear),
          figure("figure-2.11c", "Figure 2.11 (c), bending: error of the equilibrium against the resolution", 6,
                 [] { return bending(); })};
}

}  // namespace drape::bench
