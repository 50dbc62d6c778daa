#include "bench/studies/fabrics/sample.hpp"

#include <cmath>

namespace drape::bench {
namespace {

using model::Grid;
using solver::Vectors;

Vectors affine(const Grid& grid, const Eigen::RowVector3d& s_u, const Eigen::RowVector3d& s_v) {
  return grid.parameters().col(0) * s_u + grid.parameters().col(1) * s_v;
}

/// Arcs along the weft or the warp, whose chords are the edges.
Vectors bent(const Grid& grid, double kappa, bool weft) {
  const double l = weft ? grid.spacing_u() : grid.spacing_v(), angle = 2 * std::asin(kappa * l / 2);
  Vectors x = grid.parameters();
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a) {
      const int place = weft ? a : b;
      if (place == 0) continue;
      const double turn = angle * (place - 0.5);
      const int i = grid.index(a, b), before = weft ? grid.index(a - 1, b) : grid.index(a, b - 1);
      x(i, weft ? 0 : 1) = x(before, weft ? 0 : 1) + l * std::cos(turn);
      x(i, 2) = x(before, 2) + l * std::sin(turn);
    }
  return x;
}

constexpr Instrument all_instruments[] = {
    {"stretch along the weft", 0.05, false, nullptr,
     [](const Grid& g, double e) {
       return affine(g, {1 + e, 0, 0}, {0, 1, 0});
     }},
    {"stretch along the warp", 0.05, false, nullptr,
     [](const Grid& g, double e) {
       return affine(g, {1, 0, 0}, {0, 1 + e, 0});
     }},
    {"shear", 0.14, true, nullptr,
     [](const Grid& g, double e) {
       return affine(g, {1, 0, 0}, {std::sin(e), std::cos(e), 0});
     }},
    {"bending along the weft", 250, true, &model::WeftWarp::weft,
     [](const Grid& g, double kappa) { return bent(g, kappa, true); }},
    {"bending along the warp", 250, true, &model::WeftWarp::warp,
     [](const Grid& g, double kappa) { return bent(g, kappa, false); }},
};

}  // namespace

std::span<const Instrument> instruments() { return all_instruments; }

model::Scene sample_of(const model::Fabric& fabric) {
  model::Scene scene;
  scene.sheet.grid = {.nu = 5, .nv = 5, .size_u = 0.008, .size_v = 0.008};
  scene.sheet.material = fabric.material;
  scene.sheet.material.bend_projected = false;
  if (fabric.material.tables != model::FabricTables()) scene.sheet.material.law = model::StretchLaw::tables;
  return scene;
}

Sample::Sample(const model::Scene& scene, const Instrument& instrument)
    : scene_(scene), instrument_(instrument), cloth_(model::compile(scene)), y_(cloth_.start) {
  const Grid& grid = scene.sheet.grid;
  area_ = grid.size_u * grid.size_v * (instrument.bends != nullptr ? 1 - 1.0 / (grid.nu - 1) : 1);
  begin(0, 0);
}

double Sample::stress(double t, double strain) {
  const double step = 1e-6 * instrument_.largest;
  const Vectors by = (at(strain + step) - at(strain - step)) / (2 * step);
  cloth_.ode.force(t, at(strain), y_.v, f_);
  return -f_.cwiseProduct(by).sum() / area_;
}

void Sample::pass(double t, double strain) {
  if (!cloth_.ode.memory) return;
  y_.x = at(strain);
  cloth_.ode.memory->carry(t, y_);
  cloth_.ode.memory->pass(t, y_);
}

void Sample::begin(double t, double strain) {
  y_.x = at(strain);
  if (cloth_.ode.memory) cloth_.ode.memory->begin(1, t, y_);
}

}  // namespace drape::bench
