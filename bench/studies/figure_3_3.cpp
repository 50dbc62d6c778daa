#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/runs/run.hpp"
#include "bench/studies/cross_checked_reference.hpp"
#include "bench/studies/studies.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"
#include "solver/base/decompositions.hpp"

namespace drape::bench {
namespace {

using solver::SparseMatrix;
using solver::Vectors;

constexpr double lag_step = 0.01;  ///< [s]
constexpr double longest = 1;      ///< [s]
constexpr double lag_agreement = 0.1;

/// How far the centre of mass has sunk [m], step by step from t = 0 on.
struct Fall {
  std::vector<double> sunk;
  solver::Outcome outcome;

  double end() const { return lag_step * static_cast<double>(sunk.size() - 1); }

  /// When it had sunk so far for the first time, linear between steps [s]; the end if it never had.
  double time_of(double depth) const {
    const auto after = std::ranges::find_if(sunk, [depth](double s) { return s >= depth; });
    if (after == sunk.begin()) return 0;
    if (after == sunk.end()) return end();
    return lag_step * (static_cast<double>(after - sunk.begin()) - (*after - depth) / (*after - *(after - 1)));
  }
};

/// `substeps` make a step.
Fall fall(const CompiledScene& sheet, const char* method, double end, int substeps = 1) {
  const Eigen::VectorXd& mass = sheet.cloth.ode.mass;
  RunSpec spec{sheet.scene, "", &solver::method(method), lag_step / substeps, solver::thesis_options()};
  spec.scene.end = end;
  spec.options.loop_tolerance = 1e-8;
  spec.options.max_updates = 20'000;
  spec.options.linear_solver = &solver::linear_solver("cholesky");
  const auto height = [&](const solver::State& y) { return mass.dot(y.x.col(2)) / mass.sum(); };
  const double start = height(sheet.cloth.start);
  Fall seen{{0}, solver::Outcome::success};
  int count = 0;
  FunctionObserver look([&](const solver::StepReport& s) {
    if (s.h > 0 && ++count % substeps == 0) seen.sunk.push_back(start - height(s.y));
  });
  Observer* const observers[] = {&look};
  seen.outcome = run(spec, sheet.cloth, observers).result.outcome;
  return seen;
}

/// How long before its end the reference was as low as the other one is there [s]; NaN if one of them failed.
double lag(const Fall& reference, const Fall& late) {
  if (reference.outcome != solver::Outcome::success || late.outcome != solver::Outcome::success)
    return std::numeric_limits<double>::quiet_NaN();
  return late.end() - reference.time_of(late.sunk.back());
}

/// A strip of the sheet, two particles wide: along the pinned edge all is constant.
CompiledScene strip(const model::Grid& sheet, double k, double damping) {
  const model::Override overrides[] = {{"grid.n", fmt::format("[2, {}]", sheet.nv)},
                                       {"grid.size", fmt::format("[{}, {}]", sheet.spacing_u(), sheet.size_v)},
                                       {"material.tension", fmt::format("{}", k)},
                                       {"material.damping", fmt::format("{}", damping)}};
  const model::Scene scene = model::load_scene("hung-edge", overrides);
  return {scene, model::compile(scene)};
}

/// M − h² K on the free particles.
Eigen::SparseMatrix<double> slow_inertia(const solver::SplitOde& ode) {
  std::vector<bool> pinned(static_cast<std::size_t>(ode.particles()), false);
  for (const solver::Pin& pin : ode.pins) pinned[pin.particle] = true;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < ode.particles(); ++i) {
    entries.emplace_back(i, i, ode.mass[i]);
    for (SparseMatrix::InnerIterator b(ode.stiffness, i); b; ++b)
      if (!pinned[b.row()] && !pinned[b.col()]) entries.emplace_back(b.row(), b.col(), -lag_step * lag_step * b.value());
  }
  Eigen::SparseMatrix<double> inertia(ode.particles(), ode.particles());
  inertia.setFromTriplets(entries.begin(), entries.end());
  return inertia;
}

/// The motion that SBDF(2) is predicted to compute. Its f̂ = f − K x − D v is extrapolated with the error h² f̂''; where f
/// itself changes slowly that is −h² K x'', so (M − h² K) dv/dt = f: mode by mode the artificial inertia
/// (1 − ω²/κ) ν of reference/theory/amplification.hpp with ω² ≪ κ. Its first step is one of IMEX midpoint, which goes ahead
/// with the true inertia: summing (3.29) from there gives the momentum −h K (x1 − x0) that the slow motion starts with.
CompiledScene predicted_sbdf2(CompiledScene sheet) {
  model::Cloth& cloth = sheet.cloth;
  solver::SplitOde& ode = cloth.ode;
  const auto reduce = [mass = ode.mass, pins = ode.pins, inverse = base::lu_inverse(slow_inertia(ode))](Vectors& f) {
    filter(pins, f);
    for (int c = 0; c < 3; ++c) f.col(c) = mass.cwiseProduct(inverse(f.col(c)));
  };

  const RunSpec first_step{sheet.scene, "", &solver::method("sbdf2"), lag_step, {}};
  const solver::State first = run(first_step, cloth, {}, {.steps = 1}).state;
  Vectors momentum = -lag_step * (ode.stiffness * (first.x - cloth.start.x));
  reduce(momentum);
  cloth.start.v += ode.mass.cwiseInverse().asDiagonal() * momentum;

  ode.force = [=, force = ode.force](double t, const Vectors& x, const Vectors& v, Vectors& f) {
    force(t, x, v, f);
    reduce(f);
  };
  ode.jacobian = [=, jacobian = ode.jacobian](double t, const Vectors& x, const Vectors& v, SparseMatrix& df_dx,
                                              SparseMatrix& df_dv) {
    jacobian(t, x, v, df_dx, df_dv);
    for (SparseMatrix* J : {&df_dx, &df_dv}) {
      Eigen::MatrixXd dense = *J;
      for (Eigen::Index k = 0; k < dense.cols(); ++k) {
        Vectors column = Eigen::Map<Vectors>(dense.col(k).data(), x.rows(), 3);
        reduce(column);
        dense.col(k) = Eigen::Map<Eigen::VectorXd>(column.data(), column.size());
      }
      *J = dense.sparseView();
    }
  };
  return sheet;
}

/// By how much a method is behind, measured and predicted [s].
struct Lag {
  double measured, predicted;

  /// In the lag, and in the way that is left to the end.
  bool is_as_predicted(double end) const {
    return std::abs(measured - predicted) <= lag_agreement * std::min(predicted, end - predicted);
  }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Lag, measured, predicted)

/// How far the semi-implicit methods lag on one sheet.
struct Lags {
  double nu, ratio, inertia, t, sunk;
  Lag sbdf2, imex_euler;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Lags, nu, ratio, inertia, t, sunk, sbdf2, imex_euler)

using results::Role;
constexpr results::ColumnOf<Lags> lags_columns[] = {
    {"stiffness", "ν_h", "1", "h² k/(ρ l²); the thesis' figure 3.3 has 5000", Role::key, results::field<&Lags::nu>},
    {"to_damping", "h k/d", "1", "artificial damping of IMEX Euler over the cloth's own", Role::key,
     results::field<&Lags::ratio>},
    {"inertia", "inertia", "1", "artificial over true moment of inertia of the swinging sheet, 3 h² k/(ρ L²)", Role::quantity,
     results::field<&Lags::inertia>},
    {"t", "t", "s", "when they are compared: BDF(2) has sunk by a quarter of the side, or a second is over", Role::quantity,
     results::field<&Lags::t>},
    {"sunk", "sunk", "m", "BDF(2)'s centre of mass until then", Role::quantity, results::field<&Lags::sunk>},
};

constexpr results::ColumnOf<Lag> lag_columns[] = {
    {"lag_{}", "{}", "s", "by which the centre of mass is behind that of BDF(2)", Role::quantity,
     results::field<&Lag::measured>},
    {"predicted_{}", "predicted", "s",
     "the same of the true motion with artificial inertia M - h² K (SBDF) or damping d + h k (IMEX Euler)", Role::quantity,
     results::field<&Lag::predicted>},
};

constexpr results::ColumnOf<Lags> lags_verdict[] = {
    {"verdict", "verdict", "", "whether both lags, and what they leave of t, are within a tenth of what is predicted",
     Role::verdict,
     [](const Lags& row) -> results::Datum {
       return results::check(row.sbdf2.is_as_predicted(row.t) && row.imex_euler.is_as_predicted(row.t), "as predicted",
                             "not as predicted");
     }},
};

Lags lags(double nu, double ratio) {
  const model::Sheet sheet = model::load_scene("hung-edge").sheet;
  const model::Grid& grid = sheet.grid;
  const double rho = sheet.material.density, l = grid.spacing_v(), L = grid.size_v, h = lag_step;
  const double k = nu * rho * l * l / (h * h), d = h * k / ratio;
  const CompiledScene cloth = strip(grid, k, d);
  Fall bdf2 = fall(cloth, "bdf2", longest);
  const double end = h * std::ceil(bdf2.time_of(L / 4) / h - 1e-9);
  bdf2.sunk.resize(static_cast<std::size_t>(std::lround(end / h)) + 1);
  return {.nu = nu,
          .ratio = ratio,
          .inertia = 3 * h * h * k / (rho * L * L),
          .t = end,
          .sunk = bdf2.sunk.back(),
          .sbdf2 = {lag(bdf2, fall(cloth, "sbdf2", end)), lag(bdf2, fall(predicted_sbdf2(cloth), "verlet", end, 20))},
          .imex_euler = {lag(bdf2, fall(cloth, "imex-euler", end)), lag(bdf2, fall(strip(grid, k, d + h * k), "bdf2", end))}};
}

results::Table lags_table(const std::vector<Lags>& rows) {
  results::Table table = results::make_table(
      "figure-3.3", "Figure 3.3: by what time semi-implicit methods lag behind BDF(2), h = 0.01 s", lags_columns, rows);
  const auto of = [](Lag Lags::*method) { return [method](const Lags& row) { return &(row.*method); }; };
  results::add_columns(table, lag_columns, rows, of(&Lags::sbdf2), {"sbdf2", "sbdf2"});
  results::add_columns(table, lag_columns, rows, of(&Lags::imex_euler), {"imex-euler", "imex-euler"});
  results::add_columns(table, lags_verdict, rows);
  return table;
}

}  // namespace

std::vector<Job> figure_3_3(const Question& question) {
  // The exponent of the thesis' ν_h is lost: 5·10², the class of table 3.2's, or 5·10³.
  const std::vector<double> stiffnesses = question.quick ? std::vector{1e2, 1e4} : std::vector{1e2, 5e2, 1e3, 5e3, 1e4, 1e5};
  const std::vector<double> ratios = question.quick ? std::vector{1.0, 100.0} : std::vector{1.0, 10.0, 100.0, 1000.0};
  const auto compute = [=](Checkpoint& checkpoint) {
    std::vector<Lags> rows;
    checkpoint.each(stiffnesses, [&](const double nu) {
      checkpoint.each(ratios, [&](const double ratio) {
        checkpoint.show(fmt::format("ν = {}, h k/d = {}", nu, ratio));
        rows.push_back(checkpoint.once(fmt::format("{} {}", nu, ratio), [&] { return lags(nu, ratio); }));
        checkpoint.advance();
      });
    });
    return rows;
  };
  return {job("figure-3.3", static_cast<int>(stiffnesses.size() * ratios.size()), compute, lags_table)};
}

}  // namespace drape::bench
