#include "verify/support/model_fixtures.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "model/sheet/edges.hpp"

namespace drape::verify::sheets {

std::vector<ForceCase> force_cases() {
  const Material energies = made_of(tension, projected_damping, shear, contraction, unprojected_plate);
  const Material thesis = made_of(tension, linear_damping, printed_shear, contraction, plate);
  const Material with_membrane = made_of(tension, linear_damping, shear, contraction, membrane);
  const Eigen::Vector3d none = Eigen::Vector3d::Zero(), g(0.5, -0.3, -2);
  const model::Wind w{.load = {0.7, -1.1, 1.5}, .constant = 1.2, .frequency = 3, .drag = 0.9, .lift = 0.4};
  // clang-format off
  //                                                        energy   momentum angular dissipates rotation chains
  return {{"tension",             made_of(tension),           true,    true,    true,    true,     true,    true},
          {"curves",              made_of(curves),            false,   true,    true,    true,     true,    true},
          {"bent_curves",         made_of(bent_curves),       false,   true,    true,    true,     true,    false},
          {"dahl",                made_of(dahl),              false,   true,    true,    true,     true,    false},
          {"jenkin",              made_of(jenkin),            false,   true,    true,    true,     true,    false},
          {"tables",              made_of(tables),            false,   true,    true,    true,     true,    false},
          {"linear_damping",      made_of(linear_damping),    false,   true,    true,    true,     false,   true},
          {"projected_damping",   made_of(projected_damping), false,   true,    true,    true,     true,    true},
          {"shear",               made_of(shear),             true,    true,    true,    true,     true,    false},
          {"printed_shear",       made_of(printed_shear),     false,   false,   false,   false,    true,    false},
          {"diagonals",           made_of(diagonals),         true,    true,    true,    true,     true,    false},
          {"triangles",           made_of(triangles),         true,    true,    true,    true,     true,    false},
          {"hinges",              made_of(hinges),            true,    true,    true,    true,     true,    false},
          {"baraff_witkin",       made_of(baraff_witkin),     true,    true,    true,    true,     true,    false},
          {"contraction",         made_of(contraction),       true,    true,    true,    false,    true,    false},
          {"membrane",            made_of(membrane),          false,   false,   false,   false,    false,   false},
          {"plate",               made_of(plate),             false,   false,   false,   false,    false,   false},
          {"printed_plate",       made_of(printed_plate),     false,   false,   false,   false,    false,   false},
          {"printed_is_border",   made_of(printed_is_border), false,   false,   false,   false,    false,   false},
          {"unprojected_plate",   made_of(unprojected_plate), true,    true,    true,    true,     false,   true},
          {"gravity",             Material{},                 true,    false,   false,   true,     true,    true,  g},
          {"wind",                Material{},                 false,   false,   false,   true,     true,    false, none, w},
          {"air",                 Material{},                 false,   false,   true,    true,     false,   false, none, {}, 1.5},
          {"all_with_energies",   energies,                   true,    false,   false,   true,     false,   true,  g},
          {"all_of_the_thesis",   thesis,                     false,   false,   false,   false,    false,   false, g},
          {"all_with_a_membrane", with_membrane,              false,   false,   false,   false,    false,   false, g, w, 1.5}};
  // clang-format on
}

ForceCase force_case(const std::string& name) {
  const auto cases = force_cases();
  return *std::ranges::find(cases, name, &ForceCase::name);
}

Grid five_by_four() { return {5, 4, 1.0, 0.6}; }

Grid graded() {
  Grid grid = five_by_four();
  grid.grading_u = 2, grid.grading_v = 0.6;
  return grid;
}

Grid curved() {
  using enum model::CurvePiece::Kind;
  Grid grid{5, 4, 1.2, 0.95};
  grid.outline = {.lower = {{arc, {{0, 0}, {0.5, -0.1}, {1, 0.05}}}},
                  .upper = {{line, {{0.15, 0.7}, {0.6, 0.75}}}, {bezier, {{0.6, 0.75}, {0.8, 0.75}, {1.2, 0.85}}}},
                  .left = {{bezier, {{0, 0}, {-0.1, 0.2}, {0.15, 0.4}, {0.15, 0.7}}}},
                  .right = {{line, {{1, 0.05}, {1.2, 0.85}}}}};
  grid.grading_u = 1.3;
  return grid;
}

Grid cut() {
  using enum model::CurvePiece::Kind;
  Grid grid = five_by_four();
  grid.cut = {{line, {{-0.1, -0.1}, {1.1, -0.1}}},
              {line, {{1.1, -0.1}, {1.1, 0.1}}},
              {line, {{1.1, 0.1}, {0.3, 0.6}}},
              {line, {{0.3, 0.6}, {-0.1, 0.7}}},
              {arc, {{-0.1, 0.7}, {0.1, 0.3}, {-0.1, -0.1}}}};
  return grid;
}

bool exists_on(const Grid& grid, const ForceCase& force) {
  const Material& m = force.material;
  if (is_chain(grid) && !force.exists_on_chains) return false;
  return grid.uniform() || (m.shear_form == ShearForm::conservative && !by_tables(m) &&
                            (m.bend_form == BendForm::plate || (m.bend_form == BendForm::membrane && !grid.is_cut())));
}

std::vector<NamedGrid> grids() {
  return {{"2x2", {2, 2, 0.3, 0.2}},     {"3x2", {3, 2, 0.5, 0.2}},
          {"2x4", {2, 4, 0.3, 0.6}},     {"3x3", {3, 3, 0.5, 0.4}},
          {"5x4", five_by_four()},       {"chain_6x1", {6, 1, 1, 0.25}},
          {"chain_1x5", {1, 5, 0.2, 1}}, {"graded", graded()},
          {"curved", curved()},          {"cut", cut()}};
}

Scene scene_of(const ForceCase& force, const Grid& grid) {
  Scene scene;
  scene.sheet = {grid, force.material, force.gravity, force.wind, force.air};
  return scene;
}

SplitOde ode_of(const ForceCase& force, const Grid& grid) { return model::compile(scene_of(force, grid)).ode; }

std::ostream& operator<<(std::ostream& out, const Sheet& s) { return out << s.force.name << " on " << s.grid.name; }

std::vector<Sheet> sheets_where(const std::function<bool(const Sheet&)>& holds) {
  std::vector<Sheet> found;
  for (const ForceCase& force : force_cases())
    for (const NamedGrid& grid : grids())
      if (const Sheet sheet{force, grid}; exists_on(grid.grid, force) && holds(sheet)) found.push_back(sheet);
  return found;
}

std::string name_of(const testing::TestParamInfo<Sheet>& test) { return test.param.force.name + "_on_" + test.param.grid.name; }

Vectors cylinder(const Grid& grid, double kappa) {
  Vectors x = grid.parameters();
  const double l = grid.spacing_u(), angle = 2 * std::asin(kappa * l / 2);
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 1; a < grid.nu; ++a) {
      const double turn = angle * (a - 0.5);
      x.row(grid.index(a, b)) = x.row(grid.index(a - 1, b)) + l * Eigen::RowVector3d(std::cos(turn), 0, std::sin(turn));
    }
  return x;
}

double spacing(const Grid& grid) {
  const auto [weft, warp] = shortest_edges(grid);
  return std::min(weft, warp);
}

Vectors random_vectors(int n, double amplitude, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> component(-amplitude, amplitude);
  return Vectors::NullaryExpr(n, 3, [&] { return component(generator); });
}

State deformed(const Grid& grid, unsigned seed) {
  const double amplitude = spacing(grid) / 4;
  State y{grid.parameters() + random_vectors(grid.particles(), amplitude, seed),
          random_vectors(grid.particles(), amplitude, seed + 1000)};
  y.v.col(2).array() += spacing(grid);
  return y;
}

Vectors evaluate(const SplitOde::Force& force, const State& y) {
  Vectors f = Vectors::Constant(y.x.rows(), 3, 1e9);
  force(0, y.x, y.v, f);
  return f;
}

Vectors at_rest(const Vectors& x) { return Vectors::Zero(x.rows(), 3); }

double largest(const Eigen::MatrixXd& a) { return a.cwiseAbs().maxCoeff<Eigen::PropagateNaN>(); }

}  // namespace drape::verify::sheets
