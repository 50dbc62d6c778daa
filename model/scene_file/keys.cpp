#include "model/scene_file/keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "model/fabric.hpp"
#include "model/obstacles/mesh_file.hpp"
#include "model/scene_file/arcsim_material.hpp"
#include "model/scene_file/obstacle_keys.hpp"
#include "model/scene_file/outline_keys.hpp"
#include "model/scene_file/panel_keys.hpp"
#include "model/scene_file/pin_keys.hpp"

namespace drape::model {
namespace {

constexpr std::string_view damping_forms[] = {"linear", "projected"};
constexpr std::string_view shear_forms[] = {"conservative", "printed", "diagonals", "triangles", "hinges", "baraff-witkin"};
constexpr std::string_view bend_forms[] = {"membrane", "plate", "printed", "printed-is-border"};
constexpr std::string_view border_cells[] = {"dual", "whole"};
constexpr std::string_view curve_forms[] = {"affine", "smooth"};
constexpr std::string_view friction_kinds[] = {"dahl", "jenkin"};
constexpr std::string_view stretch_laws[] = {"linear", "tables"};
constexpr std::string_view rest_shapes[] = {"flat", "start"};
constexpr std::string_view planes[] = {"horizontal", "vertical"};
constexpr std::string_view detections[] = {"half-spaces", "ray"};
constexpr std::string_view responses[] = {"constraint", "reaction", "penalty", "field",
                                          "reposition", "reflect",  "impulse", "alteration"};

// --- Lists of tables: each of their entries is compared with all particles ---------------------------------------------------

std::vector<Value> rules(const Value& value) {
  constexpr std::size_t most = 1000;
  std::vector<Value> all = value.list();
  if (all.size() > most) value.fail(fmt::format("at most {} entries, not {}", most, all.size()));
  return all;
}

/// Reads the entries of a member one after the other, each with the scene as it is until then if it asks for one.
template <auto member, auto read_one>
void read_entries_of(const Value& value, Scene& scene) {
  for (const Value& entry : rules(value)) {
    if constexpr (std::is_invocable_v<decltype(read_one), const Value&, const Scene&>)
      (scene.*member).push_back(read_one(entry, scene));
    else
      (scene.*member).push_back(read_one(entry));
  }
}

template <auto member>
Data data_of_entries(const Scene& scene) {
  List all;
  for (const auto& entry : scene.*member) {
    if constexpr (requires { entries_of(entry, scene); })
      all.emplace_back(entries_of(entry, scene));
    else
      all.emplace_back(entries_of(entry));
  }
  return all;
}

// --- What is in two members --------------------------------------------------------------------------------------------------

void read_grid_n(const Value& value, Scene& scene) {
  Grid& grid = scene.sheet.grid;
  if (value.is_list()) {
    const std::vector<Value> n = value.list(2);
    grid.nu = n[0].count();
    grid.nv = n[1].count();
  } else {
    grid.nu = grid.nv = value.count();
  }
  constexpr double most = 1e7;
  if (grid.nu * static_cast<double>(grid.nv) < 2) value.fail("at least 2 particles");
  if (grid.nu * static_cast<double>(grid.nv) > most) value.fail("at most ten million particles");
}

Data grid_n_data(const Scene& scene) { return List{double(scene.sheet.grid.nu), double(scene.sheet.grid.nv)}; }

void read_grid_size(const Value& value, Scene& scene) {
  const WeftWarp size = value.weft_warp(&Value::positive);
  scene.sheet.grid.size_u = size.weft;
  scene.sheet.grid.size_v = size.warp;
}

Data grid_size_data(const Scene& scene) { return List{scene.sheet.grid.size_u, scene.sheet.grid.size_v}; }

template <auto which>
void read_outline(const Value& value, Scene& scene) {
  scene.sheet.grid.outline.*which = read_curve(rules(value));
  fit_size(scene.sheet.grid);
}

template <auto which>
Data outline_data(const Scene& scene) {
  return curve_data(scene.sheet.grid.outline.*which);
}

void read_cut(const Value& value, Scene& scene) {
  scene.sheet.grid.cut = read_curve(rules(value));
  constexpr std::size_t most = 64;
  if (scene.sheet.grid.cut.size() > most) value.fail(fmt::format("at most {} pieces", most));
}

Data cut_data(const Scene& scene) { return curve_data(scene.sheet.grid.cut); }

void read_grading(const Value& value, Scene& scene) {
  const WeftWarp grading = value.weft_warp(&Value::positive);
  constexpr double steepest = 1000;
  for (const double one : {grading.weft, grading.warp})
    if (!(one <= steepest && one * steepest >= 1)) value.fail("from 1/1000 to 1000");
  scene.sheet.grid.grading_u = grading.weft, scene.sheet.grid.grading_v = grading.warp;
}

Data grading_data(const Scene& scene) { return List{scene.sheet.grid.grading_u, scene.sheet.grid.grading_v}; }

/// Keys that follow change what the fabric has. Of a file the scene keeps the numbers alone.
void read_fabric(const Value& value, Scene& scene) {
  scene.fabric = value.text();
  if (scene.fabric.ends_with(".json")) {
    scene.sheet.material = read_arcsim_material(value.input_file("a material file of ARCSim", most_arcsim_bytes));
    scene.fabric.clear();
  }
  if (scene.fabric.empty()) return;
  std::vector<std::string_view> names;
  for (const Fabric& fabric : fabrics()) names.push_back(fabric.name);
  scene.sheet.material = fabrics()[value.one_of(names)].material;
}

Data fabric_data(const Scene& scene) { return scene.fabric; }

/// Pairs of two positive numbers.
template <class Pair>
std::vector<Pair> pairs(const Value& value) {
  std::vector<Pair> all;
  for (const Value& entry : rules(value)) {
    const std::vector<Value> parts = entry.list(2);
    all.push_back({parts[0].positive(), parts[1].positive()});
  }
  return all;
}

template <class Pair>
Data pairs_data(const std::vector<Pair>& all) {
  List list;
  for (const auto& [first, second] : all) list.emplace_back(List{first, second});
  return list;
}

/// Points of a curve that begins at the given ordinate and rises.
Polyline curve(const Value& value, double first, double last_x) {
  std::vector<Polyline::Point> points;
  for (const Value& entry : rules(value)) {
    const std::vector<Value> parts = entry.list(2);
    points.push_back({parts[0].non_negative(), parts[1].non_negative()});
  }
  if (points.size() < 2 || points.front()[1] != 0 || !(points.front()[0] <= first) ||
      (last_x > 0 && points.back() != Polyline::Point{last_x, last_x}))
    value.fail(last_x > 0 ? "points from [part of the largest strain, 0] to [1, 1]" : "at least two points, the first [0, 0]");
  for (std::size_t k = 1; k < points.size(); ++k)
    if (!(points[k][0] > points[k - 1][0]) || !(points[k][1] >= points[k - 1][1]))
      value.fail(fmt::format("strains that grow and stresses that do not fall, unlike point {}", k));
  return Polyline(std::move(points));
}

/// `modulus`: what the first slope replaces.
template <StressCurve Material::*which, auto modulus>
void read_curve(const Value& value, Scene& scene) {
  Material& m = scene.sheet.material;
  m.*which = {};
  if (value.list().empty()) return;
  (m.*which).loading = curve(value, 0, 0);
  modulus(m) = (m.*which).loading.slope(0);
  if (!(modulus(m) > 0)) value.fail("a first piece that rises");
}

constexpr auto k1 = [](Material& m) -> double& { return m.tension.weft; };
constexpr auto k2 = [](Material& m) -> double& { return m.tension.warp; };
constexpr auto G = [](Material& m) -> double& { return m.shear; };
constexpr auto B1 = [](Material& m) -> double& { return m.bend.weft; };
constexpr auto B2 = [](Material& m) -> double& { return m.bend.warp; };

/// Curves and friction of bending are moments of a plate.
template <StressCurve Material::*which, auto modulus>
void read_bend_curve(const Value& value, Scene& scene) {
  read_curve<which, modulus>(value, scene);
  if ((scene.sheet.material.*which).given() && scene.sheet.material.bend_form != BendForm::plate)
    value.fail("material.bend_form \"plate\" with a curve of bending");
}

void read_shear_curve(const Value& value, Scene& scene) {
  read_curve<&Material::shear_curve, G>(value, scene);
  if (scene.sheet.material.shear_curve.given() && scene.sheet.material.shear_form != ShearForm::conservative)
    value.fail("material.shear_form \"conservative\" with a curve of shear");
}

// --- Tables of a fabric ------------------------------------------------------------------------------------------------------

template <std::size_t rows, std::size_t columns>
void read_rows(const Value& value, std::array<std::array<double, columns>, rows>& table) {
  table = {};
  if (!value.list().empty()) table = value.numbers<rows, columns>();
}

template <auto which>
void read_numbers(const Value& value, Scene& scene) {
  read_rows(value, scene.sheet.material.tables.*which);
}

/// No rows if all numbers are 0.
template <auto which>
Data table_data(const Scene& scene) {
  const auto& table = scene.sheet.material.tables.*which;
  List rows;
  if (table == std::remove_cvref_t<decltype(table)>{}) return rows;
  for (const auto& row : table) rows.emplace_back(List(row.begin(), row.end()));
  return rows;
}

void read_law(const Value& value, Scene& scene) {
  Material& m = scene.sheet.material;
  m.law = static_cast<StretchLaw>(value.one_of(stretch_laws));
  if (!by_tables(m)) return;
  if (m.tables.stretching == FabricTables{}.stretching)
    value.fail("a material.fabric or a material.stretch_table with \"tables\"");
  if (m.shear_form != ShearForm::conservative || m.weft_curve.given() || m.warp_curve.given() || m.shear_curve.given())
    value.fail("no curves and no other form of shear with \"tables\"");
}

Data law_data(const Scene& scene) { return std::string(stretch_laws[static_cast<int>(scene.sheet.material.law)]); }

/// A loop that is passed the right way round loses energy.
template <StressCurve Material::*which>
void read_unloading(const Value& value, Scene& scene) {
  StressCurve& both = scene.sheet.material.*which;
  both.unloading = {};
  if (value.list().empty()) return;
  if (!both.given()) value.fail("the curve of loading as well");
  both.unloading = curve(value, 1, 1);
  for (const auto& [largest, stress] : both.loading.points())
    for (const auto& [part, share] : both.unloading.points())
      if (share * stress > both.loading.value(part * largest) * (1 + 1e-12))
        value.fail(fmt::format(
            "less stress than in loading: at {:g} of the strain {:g} it is more, and loops would feed energy", part, largest));
}

template <StressCurve Material::*which, Polyline StressCurve::*branch>
Data curve_data(const Scene& scene) {
  List list;
  for (const auto& [x, y] : (scene.sheet.material.*which.*branch).points()) list.emplace_back(List{x, y});
  return list;
}

void read_maxwell(const Value& value, Scene& scene) {
  double sum = 0;
  for (const MaxwellElement& element : scene.sheet.material.relaxation.maxwell = pairs<MaxwellElement>(value))
    sum += element.part;
  if (!(sum < 1)) value.fail("parts whose sum is below 1, or nothing would hold the sheet");
}

Data maxwell_data(const Scene& scene) { return pairs_data(scene.sheet.material.relaxation.maxwell); }

void read_series(const Value& value, Scene& scene) {
  scene.sheet.material.relaxation.series = pairs<KelvinVoigtElement>(value);
}

Data series_data(const Scene& scene) { return pairs_data(scene.sheet.material.relaxation.series); }

void read_band(const Value& value, Scene& scene) {
  const std::vector<Value> ends = value.list(2);
  const Band band = {ends[0].positive(), ends[1].positive()};
  constexpr double widest = 1e6;
  if (!(band[0] < band[1] && band[1] <= widest * band[0]))
    value.fail("[lowest, highest], the highest at most a million times the lowest");
  scene.sheet.material.relaxation.band = band;
}

Data band_data(const Scene& scene) {
  const Band& band = scene.sheet.material.relaxation.band;
  return List{band[0], band[1]};
}

void read_pleats(const Value& value, Scene& scene) {
  const std::vector<Value> parts = value.list(2);
  const double count = parts[0].non_negative(), degrees = parts[1].non_negative();
  const int most = (scene.sheet.grid.nu - 1) / 2;
  if (count > most || count != static_cast<int>(count) || degrees >= 90)
    value.fail(fmt::format("a whole number of at most {} waves, for two edges each, and an angle below 90 degrees", most));
  scene.start.pleats = {static_cast<int>(count), degrees};
}

Data pleats_data(const Scene& scene) { return List{double(scene.start.pleats.count), scene.start.pleats.degrees}; }

void read_trim(const Value& value, Scene& scene) {
  scene.trim.file = value.text().empty() ? "" : value.input_file("the file of a mesh", most_mesh_bytes);
}

Data trim_data(const Scene& scene) { return scene.trim.file; }

// --- The table ---------------------------------------------------------------------------------------------------------------

template <auto member>
constexpr auto in_sheet = at<&Scene::sheet, member>;
template <auto... members>
constexpr auto in_material = at<&Scene::sheet, &Sheet::material, members...>;
template <auto member>
constexpr auto in_wind = at<&Scene::sheet, &Sheet::wind, member>;
template <auto member>
constexpr auto in_contact = at<&Scene::contact, member>;
template <auto member>
constexpr auto in_start = at<&Scene::start, member>;

bool is_membrane(const Scene& scene) { return scene.sheet.material.bend_form == BendForm::membrane; }
std::string_view bend_unit(const Scene& scene) { return is_membrane(scene) ? "N/m" : "N m"; }
std::string_view bend_damping_unit(const Scene& scene) { return is_membrane(scene) ? "N s/m" : "N m s"; }

std::vector<SceneKey> own_keys() {
  static const std::string of_obstacles = obstacle_help();
  // clang-format off
  static const Key<Scene> table[] = {
      {"name", "", "what tables and files call the scene [the file's name without .toml]", at<&Scene::name>, check::title},
      {"description", "", "one sentence", at<&Scene::description>, check::text},

      {"grid.n", "", "particles along weft and warp: one number or [nu, nv]; 1 makes a chain", read_grid_n, grid_n_data},
      {"grid.size", "m", "sides along weft and warp: one number or two; of a chain also the width it stands for",
       read_grid_size, grid_size_data},
      {"grid.border_cells", "", "\"dual\" (half on borders) or \"whole\" (as the algorithms of the thesis print it)",
       at<&Scene::sheet, &Sheet::grid, &Grid::border_cells>, check::one_of<border_cells>},

      {"grid.grading", "1", "the last spacing over the first along weft and warp, between which they grow by a constant factor: one number or two",
       read_grading, grading_data},
      {"grid.lower", "", "with right, upper and left the sides of a curved panel in the plane of its pattern, lower and upper along u, left and right along v: list of { line = [[x, y], [x, y]] | arc = [three points] | bezier = [control points] } in metres; grid.size is then the box around it",
       read_outline<&Outline::lower>, outline_data<&Outline::lower>},
      {"grid.right", "", "up from where lower ends", read_outline<&Outline::right>, outline_data<&Outline::right>},
      {"grid.upper", "", "from left to right", read_outline<&Outline::upper>, outline_data<&Outline::upper>},
      {"grid.left", "", "up from where lower begins", read_outline<&Outline::left>, outline_data<&Outline::left>},
      {"grid.cut", "", "a closed curve on the pattern, inside of which there is cloth: list of pieces as those of the sides", read_cut,
       cut_data},

      {"material.fabric", "", "a measured cloth, see bench_integrators list fabrics, or a material file of ARCSim (.json): its density and moduli, which other keys change",
       read_fabric, fabric_data},
      {"material.density", "kg/m²", "ρ", in_material<&Material::density>, check::positive},
      {"material.tension", "N/m", "k1, k2: one number for both, or [weft, warp]",
       in_material<&Material::tension>, check::non_negative},
      {"material.weft_curve", "", "instead of k1, a curve of loading: list of [strain, N/m] from [0, 0]",
       read_curve<&Material::weft_curve, k1>, curve_data<&Material::weft_curve, &StressCurve::loading>},
      {"material.weft_unloading", "", "its curve of unloading: list of [part of the largest strain, part of its stress] to [1, 1]; what it begins with remains",
       read_unloading<&Material::weft_curve>, curve_data<&Material::weft_curve, &StressCurve::unloading>},
      {"material.warp_curve", "", "the same instead of k2",
       read_curve<&Material::warp_curve, k2>, curve_data<&Material::warp_curve, &StressCurve::loading>},
      {"material.warp_unloading", "", "and its curve of unloading",
       read_unloading<&Material::warp_curve>, curve_data<&Material::warp_curve, &StressCurve::unloading>},
      {"material.damping", "N s/m", "d1, d2: viscous tension, one number for both, or [weft, warp]",
       in_material<&Material::damping>, check::non_negative},
      {"material.damping_form", "", "\"linear\" (treated implicitly, also damps transversally) or \"projected\"",
       in_material<&Material::damping_form>, check::one_of<damping_forms>},
      {"material.shear", "N/m", "G", in_material<&Material::shear>, check::non_negative},
      {"material.shear_damping", "N s/m", "dG", in_material<&Material::shear_damping>, check::non_negative},
      {"material.shear_form", "", "\"conservative\", \"printed\" (Algorithm 2 of the thesis), \"diagonals\", \"triangles\", \"hinges\" or \"baraff-witkin\"",
       in_material<&Material::shear_form>, check::one_of<shear_forms>},
      {"material.shear_curve", "", "instead of G, a curve of loading: list of [<s_u, s_v>, N/m] from [0, 0]",
       read_shear_curve, curve_data<&Material::shear_curve, &StressCurve::loading>},
      {"material.shear_unloading", "", "and its curve of unloading",
       read_unloading<&Material::shear_curve>, curve_data<&Material::shear_curve, &StressCurve::unloading>},
      {"material.shear_friction", "N/m", "HG: largest friction in shear, half the width of its hysteresis",
       in_material<&Material::friction, &Friction::shear>, check::non_negative},
      {"material.shear_friction_onset", "1", "shear <s_u, s_v> in which it develops",
       in_material<&Material::friction, &Friction::shear_onset>, check::positive},
      {"material.quality", "1", "Q of tension and shear, the same throughout the band; 0: they do not relax",
       in_material<&Material::relaxation, &Relaxation::quality>, check::non_negative},
      {"material.band", "rad/s", "[lowest, highest]: where Q is as wished", read_band, band_data},
      {"material.maxwell", "", "instead of Q, Maxwell elements of tension and shear: list of [rate in 1/s, part of the modulus]",
       read_maxwell, maxwell_data},
      {"material.series", "", "or Kelvin-Voigt elements in series with them (2.34): list of [k_j/d_j in 1/s, k_0/k_j]",
       read_series, series_data},
      {"material.contraction", "N/m", "C12: transverse contraction, with C12² below k1 k2",
       in_material<&Material::contraction>, check::non_negative},
      {"material.contraction_damping", "N s/m", "d12", in_material<&Material::contraction_damping>, check::non_negative},
      {"material.bend", {"N m, of the membrane N/m", bend_unit}, "B1, B2: one number for both, or [weft, warp]",
       in_material<&Material::bend>, check::non_negative},
      {"material.bend_damping", {"N m s, of the membrane N s/m", bend_damping_unit}, "viscous counterparts of B1, B2",
       in_material<&Material::bend_damping>, check::non_negative},
      {"material.bend_form", "", "\"plate\" (fourth order), \"membrane\" (second order), \"printed\" (Algorithm 4 of the thesis) or \"printed-is-border\" (with the border rule of 6.2.1)",
       in_material<&Material::bend_form>, check::one_of<bend_forms>},
      {"material.bend_projected", "", "plate only: forces along the vertex normal (as the thesis) or, if false, in all directions",
       in_material<&Material::bend_projected>, check::flag},
      {"material.weft_bend_curve", "", "instead of B1, a curve of loading: list of [curvature in 1/m, N] from [0, 0]",
       read_bend_curve<&Material::weft_bend_curve, B1>, curve_data<&Material::weft_bend_curve, &StressCurve::loading>},
      {"material.weft_bend_unloading", "", "and its curve of unloading",
       read_unloading<&Material::weft_bend_curve>, curve_data<&Material::weft_bend_curve, &StressCurve::unloading>},
      {"material.warp_bend_curve", "", "the same instead of B2",
       read_bend_curve<&Material::warp_bend_curve, B2>, curve_data<&Material::warp_bend_curve, &StressCurve::loading>},
      {"material.warp_bend_unloading", "", "and its curve of unloading",
       read_unloading<&Material::warp_bend_curve>, curve_data<&Material::warp_bend_curve, &StressCurve::unloading>},
      {"material.curve_form", "", "\"affine\" pieces between the points of curves or \"smooth\" ones",
       in_material<&Material::curve_form>, check::one_of<curve_forms>},
      {"material.bend_friction", "N", "HB, largest friction in bending, half the width 2HB of its hysteresis: one number for both, or [weft, warp]",
       in_material<&Material::friction, &Friction::bend>, check::non_negative},
      {"material.bend_friction_onset", "1/m", "curvature in which it develops",
       in_material<&Material::friction, &Friction::bend_onset>, check::positive},
      {"material.friction_law", "", "\"dahl\" (approaches its limit exponentially) or \"jenkin\" (elastic up to its limit)",
       in_material<&Material::friction, &Friction::law>, check::one_of<friction_kinds>},
      {"material.stretch_table", "N/m", "C11, C12, C22, C33 of a fabric, half of them, in six rows: at rest, and stretched by a sixth along 0, 22.5, 45, 67.5 and 90 degrees",
       read_numbers<&FabricTables::stretching>, table_data<&FabricTables::stretching>},
      {"material.bend_table", "N m", "B along 0, 45 and 90 degrees, each for curvatures of 0, 10, 20, 30 and 40/m",
       read_numbers<&FabricTables::bending>, table_data<&FabricTables::bending>},
      {"material.law", "", "\"linear\" (by the moduli) or \"tables\" (by those of the fabric instead of k1, k2, C12, G; B beside them)",
       read_law, law_data},

      {"forces.gravity", "m/s²", "g: [x, y, z]", in_sheet<&Sheet::gravity>, check::number},
      {"forces.wind", "N/m²", "w: [x, y, z]; the wind is (a + sin ωt) w", in_wind<&Wind::load>, check::number},
      {"forces.wind_constant", "1", "a: the steady part of the wind", in_wind<&Wind::constant>, check::number},
      {"forces.wind_frequency", "rad/s", "ω: 0 for a steady wind", in_wind<&Wind::frequency>, check::non_negative},
      {"forces.drag", "1", "c_drag: part of the wind that acts along the normals", in_wind<&Wind::drag>, check::non_negative},
      {"forces.lift", "1", "c_lift: part of the wind that acts across the normals", in_wind<&Wind::lift>, check::non_negative},
      {"forces.air", "N s/m³", "c_w ρ_air: resistance of the air to motion across the sheet",
       in_sheet<&Sheet::air>, check::non_negative},

      {"obstacles", "", of_obstacles, read_entries_of<&Scene::obstacles, read_obstacle>, data_of_entries<&Scene::obstacles>},

      {"contact.distance", "m", "d: what is nearer to an obstacle than this is in its collision area",
       in_contact<&ContactRule::distance>, check::positive},
      {"contact.relaxation", "1", "ω: part of its depth in the collision area that a particle loses in a step; from 1 to 2 it is thrown out and may bounce",
       in_contact<&ContactRule::relaxation>, check::up_to_two},
      {"contact.thickness", "m", "distance that cloth keeps from itself; 0: it passes through itself",
       in_contact<&ContactRule::thickness>, check::non_negative},
      {"contact.self_friction", "1", "μ between layers of cloth that keep a thickness", in_contact<&ContactRule::self_friction>,
       check::non_negative},
      {"contact.faces", "", "whether cloth between its particles keeps contact.distance from edges and corners of obstacles, which else it only does at particles",
       in_contact<&ContactRule::faces>, check::flag},
      {"contact.response", "", "\"constraint\" (of velocities in the linear systems), \"alteration\" (of what is inside when a step begins), forces: \"reaction\" (damped springs instead of others), \"penalty\" (a steep potential), \"field\" (exponential, damped), or changes after a step: \"reposition\" (to the border, at rest), \"reflect\", \"impulse\" (against the force)",
       in_contact<&ContactRule::response>, check::one_of<responses>},
      {"contact.detection", "", "of particles that may touch an obstacle: \"half-spaces\" (behind its nearest points) or \"ray\" (at which each ends its free flight, or its step; obstacles are the closed, rigid meshes that are drawn)",
       in_contact<&ContactRule::detection>, check::one_of<detections>},
      {"contact.reaction_time", "s", "τ: the springs of reactions have k = m/τ² and d = 2m/τ",
       in_contact<&ContactRule::reaction_time>, check::positive},
      {"contact.push", "m/s²", "c: force of penalty and field on a unit of mass at distance d from an obstacle",
       in_contact<&ContactRule::push>, check::positive},
      {"contact.exponent", "1", "n: the penalty is m c (d/r)ⁿ at distance r from an obstacle",
       in_contact<&ContactRule::exponent>, check::positive},
      {"contact.range", "m", "e: the field is m c exp((d − r)/e), with damping that is critical in a rest at distance d",
       in_contact<&ContactRule::range>, check::positive},
      {"contact.restitution", "1", "e: part of the normal velocity with which \"reflect\" sends particles back",
       in_contact<&ContactRule::restitution>, check::part_or_none},
      {"contact.adaptive", "", "whether springs that an edge of an obstacle divides pull at it: virtual particles of one step (chapter 5)",
       in_contact<&ContactRule::adaptive>, check::flag},

      {"start.plane", "", "\"horizontal\" (v along y) or \"vertical\" (v along z)", in_start<&Start::plane>, check::one_of<planes>},
      {"start.stretch", "1", "factors along weft and warp at t = 0", in_start<&Start::stretch>, check::positive},
      {"start.pleats", "", "[count, degrees]: waves along the weft without strain, and how steep they are at t = 0",
       read_pleats, pleats_data},
      {"start.velocity", "m/s", "velocity: [x, y, z] of all particles at t = 0", in_start<&Start::velocity>, check::number},

      {"start.wrap", "1", "depth over width of an ellipse around the z axis: lines along the weft of a vertical sheet begin on its half at -y; 0: straight",
       in_start<&Start::wrap>, check::non_negative},
      {"start.rotation", "degrees", "axis times angle, about the origin, at t = 0", in_start<&Start::rotation>, check::number},
      {"start.position", "m", "of the origin of the pattern at t = 0", in_start<&Start::position>, check::number},

      {"trim.file", "", "a flat mesh of triangles on the pattern, which is drawn in the place of the grid (2.7)",
       read_trim, trim_data},
      {"trim.scale", "1", "metres for a unit of that file", at<&Scene::trim, &Trim::scale>, check::positive},
      {"trim.outline", "", "whether that is a mesh of the grid's sides or its cut, which the program makes",
       at<&Scene::trim, &Trim::outline>, check::flag},

      {"panels", "", "list of { name, grid, material, start, trim }: cloth of several panels, each with keys of these sections, which change those of the scene",
       read_entries_of<&Scene::panels, read_panel>, data_of_entries<&Scene::panels>},
      {"seams", "", "list of { one, other, ease }: sides { panel, side, ends } whose particles are one; one may be longer by the part ease",
       read_entries_of<&Scene::seams, read_seam>, data_of_entries<&Scene::seams>},
      {"pins", "", "list of { panel, where | particles | circle, directions | direction, velocity | path }: prescribed motion", read_entries_of<&Scene::pins, read_pin>, data_of_entries<&Scene::pins>},
      {"phases", "", "list of { until, gravity, seams, pins }: times in which these are other than after the last", read_entries_of<&Scene::phases, read_phase>, data_of_entries<&Scene::phases>},

      {"rest.shape", "", "\"flat\" or \"start\": bending is at rest in the shape at t = 0",
       at<&Scene::rest>, check::one_of<rest_shapes>},

      {"end.time", "s", "simulated time", at<&Scene::end>, check::positive},
  };
  // clang-format on
  return {std::begin(table), std::end(table)};
}

/// The rows, and those that are added.
std::vector<SceneKey>& key_table() {
  static std::vector<SceneKey> all = own_keys();
  return all;
}

}  // namespace

std::span<const SceneKey> scene_key_table() { return key_table(); }

void add_scene_key(SceneKey key) { key_table().push_back(std::move(key)); }

}  // namespace drape::model
