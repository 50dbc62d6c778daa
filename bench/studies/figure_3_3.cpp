#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bench/studies.hpp"
#include "model/scene_file.hpp"
#include "results/table_builder.hpp"
#include "solver/decompositions.hpp"

namespace drape::bench {
namespace {

constexpr double step = 0.01;  // s
constexpr double share = 0.25;  ///< of its length, by which the sheet's centre of mass sinks

/// How far the centre of mass has sunk [m] at equal steps from t = 0 on.
using Fall = std::vector<double>;

/// Nothing if the run fails. Steps of h/substeps, of which every one of `substeps` counts.
std::optional<Fall> fall(const model::Cloth& cloth, const char* method, double end, int substeps = 1) {
  solver::Options options;
  options.loop_tolerance = 1e-8;
  options.cg_tolerance = 1e-10;
  options.max_updates = 20'000;
  options.linear_solver = &solver::linear_solver("cholesky");
  const auto height = [&](const solver::State& y) { return cloth.ode.mass.dot(y.x.col(2)) / cloth.ode.mass.sum(); };
  solver::Integrator integrator(cloth.ode, solver::method(method), options, cloth.start);
  const double start = height(integrator.state());
  Fall sunk{0};
  int k = 0;
  const auto result = integrate(integrator, end, step / substeps, [&](const solver::StepReport& s) {
    if (++k % substeps == 0) sunk.push_back(start - height(s.y));
  });
  if (result.outcome != solver::Outcome::success) return {};
  return sunk;
}

/// When it had sunk so far: the first time, linear between steps.
double time_of(const Fall& fall, double sunk) {
  const auto after = std::ranges::find_if(fall, [&](double s) { return s >= sunk; });
  if (after == fall.begin()) return 0;
  if (after == fall.end()) return step * static_cast<double>(fall.size() - 1);
  return step * (static_cast<double>(after - fall.begin()) - (*after - sunk) / (*after - *(after - 1)));
}

/// A strip of the sheet of figure 3.3, two particles wide: all is constant along the pinned edge.
model::Cloth strip(double k, double d) {
  const std::vector<model::Override> overrides{{"grid.n", "[2, 20]"},
                                               {"grid.size", fmt::format("[{}, 0.8]", 0.8 / 19)},
                                               {"material.tension", fmt::format("{}", k)},
                                               {"material.damping", fmt::format("{}", d)}};
  return model::compile(model::load_scene("hung-edge", overrides));
}

/// As SBDF(2) is predicted to move it: (M − h² K) dv/dt = f.
model::Cloth with_inertia(model::Cloth cloth) {
  solver::SplitOde& ode = cloth.ode;
  std::vector<bool> pinned(ode.particles(), false);
  for (const solver::Pin& pin : ode.pins) pinned[pin.particle] = true;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < ode.particles(); ++i) {
    entries.emplace_back(i, i, ode.mass[i]);
    for (solver::SparseMatrix::InnerIterator b(ode.stiffness, i); b; ++b)
      if (!pinned[b.row()] && !pinned[b.col()]) entries.emplace_back(b.row(), b.col(), -step * step * b.value());
  }
  Eigen::SparseMatrix<double> inertia(ode.particles(), ode.particles());
  inertia.setFromTriplets(entries.begin(), entries.end());
  const auto reduce = [mass = ode.mass, pins = ode.pins, inverse = solver::lu_inverse(inertia)](auto&& f) {
    for (int c = 0; c < 3; ++c) f.col(c) = mass.cwiseProduct(inverse(f.col(c)));
  };
  ode.force = [=, force = ode.force, pins = ode.pins](double t, const solver::Vectors& x, const solver::Vectors& v,
                                                      solver::Vectors& f) {
    force(t, x, v, f);
    solver::filter(pins, f);
    reduce(f);
  };
  ode.jacobian = [=, jacobian = ode.jacobian, pins = ode.pins](double t, const solver::Vectors& x, const solver::Vectors& v,
                                                               solver::SparseMatrix& df_dx, solver::SparseMatrix& df_dv) {
    jacobian(t, x, v, df_dx, df_dv);
    for (solver::SparseMatrix* J : {&df_dx, &df_dv}) {
      Eigen::MatrixXd dense = *J;
      for (Eigen::Index k = 0; k < dense.cols(); ++k) {
        solver::Vectors column = Eigen::Map<solver::Vectors>(dense.col(k).data(), x.rows(), 3);
        solver::filter(pins, column);
        reduce(column);
        dense.col(k) = Eigen::Map<Eigen::VectorXd>(column.data(), column.size());
      }
      *J = dense.sparseView();
    }
  };
  return cloth;
}

results::Table compute(bool quick, Progress& progress) {
  results::TableBuilder table("figure-3.3", "x");
  for (const double nu : {1e2, 1e3, 5e3, 1e4, 1e5})
    for (const double ratio : {1.0, 10.0, 100.0, 1000.0}) {
      const double l = 0.8/19, k = nu * l * l / step / step, d = step * k / ratio;
      const model::Cloth cloth = strip(k, d);
      auto ref = fall(cloth, "bdf2", 1.0);
      const bool ok = ref.has_value();
      if (!ref) ref = fall(cloth, "verlet", 1.0);
      const double T = std::min(1.0, time_of(*ref, share * 0.8));
      const double end = std::ceil(T/step - 1e-9)*step;
      auto at = [&](const std::optional<Fall>& f) { return f ? time_of(*ref, f->back()) : NAN; };
      table.row();
      table.number("nu", "nu", "1", "", nu);
      table.number("r", "hk/d", "1", "", ratio);
      table.number("d", "d", "1", "", d);
      table.text("ref", "ref", "", ok ? "bdf2" : "verlet");
      table.number("T", "T", "s", "", end);
      table.number("drop", "drop", "m", "", (*ref)[std::lround(end/step)]);
      table.number("s", "sbdf2", "s", "", end - at(fall(cloth, "sbdf2", end)));
      table.number("sp", "pred", "s", "", end - at(fall(with_inertia(cloth), "verlet", end, 20)));
      table.number("i", "imex", "s", "", end - at(fall(cloth, "imex-euler", end)));
      table.number("ip", "pred", "s", "", end - at(fall(strip(k, d + step * k), "bdf2", end)));
      progress.advance();
      fmt::print(stderr, "{} {} done\n", nu, ratio);
    }
  return table.finish();
}

}  // namespace

std::vector<TableJob> figure_3_3(bool quick) {
  return {{1, [quick](Progress& progress) { return compute(quick, progress); }}};
}

}  // namespace drape::bench
