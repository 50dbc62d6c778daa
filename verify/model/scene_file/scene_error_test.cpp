// Scenes that are wrong are refused in one line that says where, which key, and what would be right.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "model/scene_file/scene_file.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify::scene_error_test {
namespace {

using model::load_scene;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// The message of the SceneError that `read` throws; empty if it throws none.
template <class Read>
std::string message(const Read& read) {
  try {
    read();
  } catch (const model::SceneError& error) {
    return error.what();
  }
  return "";
}

/// A scene that must be refused. Its file begins with a line for the name; `lines` follow.
struct BadScene {
  std::string name;
  std::string lines;
  std::string says;      ///< how the message begins
  std::string set = {};  ///< an override
};

void PrintTo(const BadScene& bad, std::ostream* out) { *out << bad.name; }

std::string repeated(int times, const std::string& text) { return times == 0 ? "" : text + repeated(times - 1, text); }

const std::string count = "expected a whole number from 1 to 10000000";
const std::string chain_bends = "expected bend_form = \"plate\" with bend_projected = false, a chain has no normals";

// clang-format off
const std::vector<BadScene> bad_scenes = {
    {"unknown_key", "foo = 1", "a.toml:2: unknown key 'foo': expected one of name, description, grid.n, "},
    {"unknown_section", "[foo]\nbar = 1", "a.toml:2: unknown key 'foo': expected one of name, "},
    {"unknown_key_in_a_section", "[material]\n\ndensty = 1",
     "a.toml:4: unknown key 'material.densty' (did you mean material.density?): expected one of material.fabric, material.density, "},
    {"unknown_key_in_a_pin", "[[pins]]\nwher = 'all'", "a.toml:3: pins.wher = 'all': "},
    {"number_for_a_section", "material = 1", "a.toml:2: unknown key 'material': expected one of "},
    {"list_of_sections", "[[grid]]\nn = 3", "a.toml:2: unknown key 'grid': expected one of "},
    {"key_twice", "description = 'a'\ndescription = 'b'", "a.toml:3: "},
    {"syntax_error", "[grid]\nn = \n", "a.toml:3: Error while parsing key-value pair: expected value, saw "},

    {"unknown_base", "base = 'felt'", "a.toml:2: base = 'felt': expected the name of a scene or a file: unknown scene 'felt': expected one of ball, "},
    {"number_for_a_base", "base = 3", "a.toml:2: base = 3: expected a text in quotes"},
    {"base_of_a_base", "base = 'walking_dress'", "a.toml:2: base = 'walking_dress': expected a scene without a base of its own"},
    {"base_that_is_no_file", "base = 'nowhere.toml'", "a.toml:2: base = 'nowhere.toml': "},
    {"key_of_no_base", "base = 'ball'\ngrid.m = 3", "a.toml:3: unknown key 'grid.m'"},

    {"not_a_number", "[material]\ndensity = nan", "a.toml:3: material.density = nan: expected a finite number"},
    {"infinity", "end.time = inf", "a.toml:2: end.time = inf: expected a finite number"},
    {"infinity_in_a_list", "material.tension = [1, -inf]", "a.toml:2: material.tension = -inf: expected a finite number"},
    {"not_a_number_in_a_vector", "forces.gravity = [0, nan, 1]", "a.toml:2: forces.gravity = nan: expected a finite number"},
    {"negative_density", "[material]\ndensity = -1", "a.toml:3: material.density = -1: expected a number above 0"},
    {"zero_density", "[material]\ndensity = 0.0", "a.toml:3: material.density = 0.0: expected a number above 0"},
    {"negative_modulus", "material.shear = -2", "a.toml:2: material.shear = -2: expected a number of at least 0"},
    {"negative_modulus_in_a_list", "material.bend = [1, -2]", "a.toml:2: material.bend = -2: expected a number of at least 0"},
    {"no_length", "grid.size = [1, 0]", "a.toml:2: grid.size = 0: expected a number above 0"},
    {"no_stretch", "start.stretch = 0", "a.toml:2: start.stretch = 0: expected a number above 0"},
    {"no_time", "end.time = 0", "a.toml:2: end.time = 0: expected a number above 0"},

    {"text_for_a_number", "material.density = 'heavy'", "a.toml:2: material.density = 'heavy': expected a number"},
    {"flag_for_a_number", "material.shear = true", "a.toml:2: material.shear = true: expected a number"},
    {"table_for_a_number", "material.shear = {a = 1}", "a.toml:2: material.shear = "},
    {"number_for_a_text", "description = 7", "a.toml:2: description = 7: expected a text in quotes"},
    {"number_for_a_flag", "material.bend_projected = 1", "a.toml:2: material.bend_projected = 1: expected true or false"},
    {"number_for_a_vector", "forces.gravity = -9", "a.toml:2: forces.gravity = -9: expected a list of 3 numbers"},
    {"short_vector", "forces.gravity = [0, -9]", "a.toml:2: forces.gravity = [ 0, -9 ]: expected a list of 3 numbers"},
    {"long_list", "material.tension = [1, 2, 3]", "a.toml:2: material.tension = [ 1, 2, 3 ]: expected a list of 2 numbers"},
    {"unknown_word", "material.bend_form = 'disk'", "a.toml:2: material.bend_form = 'disk': expected one of \"membrane\", \"plate\", \"printed\""},
    {"number_for_a_word", "start.plane = 3", "a.toml:2: start.plane = 3: expected one of \"horizontal\", \"vertical\""},

    {"unknown_fabric", "material.fabric = 'felt'", "a.toml:2: material.fabric = 'felt': expected one of \"blanket\", \"cotton-broad\", \"denim\", "},
    {"curve_of_one_point", "material.weft_curve = [[0, 0]]", "a.toml:2: material.weft_curve = [ [ 0, 0 ] ]: expected at least two points, the first [0, 0]"},
    {"curve_that_begins_elsewhere", "material.weft_curve = [[0, 1], [0.1, 2]]", "a.toml:2: material.weft_curve = "},
    {"unsorted_curve", "material.warp_curve = [[0, 0], [0.5, 3], [0.25, 4]]",
     "a.toml:2: material.warp_curve = [ [ 0, 0 ], [ 0.5, 3 ], [ 0.25, 4 ] ]: expected strains that grow and stresses that do not fall, unlike point 2"},
    {"falling_curve", "material.warp_curve = [[0, 0], [0.1, 3], [0.2, 2]]", "a.toml:2: material.warp_curve = "},
    {"curve_with_a_jump", "material.warp_curve = [[0, 0], [0.1, 3], [0.1, 4]]", "a.toml:2: material.warp_curve = "},
    {"flat_beginning", "material.weft_curve = [[0, 0], [0.1, 0], [0.2, 1]]", "a.toml:2: material.weft_curve = "},
    {"unloading_alone", "material.weft_unloading = [[0, 0], [1, 1]]", "a.toml:2: material.weft_unloading = [ [ 0, 0 ], [ 1, 1 ] ]: expected the curve of loading as well"},
    {"unloading_without_an_end", "material.weft_curve = [[0, 0], [0.1, 1]]\nmaterial.weft_unloading = [[0, 0], [0.75, 1]]",
     "a.toml:3: material.weft_unloading = [ [ 0, 0 ], [ 0.75, 1 ] ]: expected points from [part of the largest strain, 0] to [1, 1]"},
    {"unloading_above_loading", "material.weft_curve = [[0, 0], [0.1, 1]]\nmaterial.weft_unloading = [[0, 0], [0.5, 0.75], [1, 1]]",
     "a.toml:3: material.weft_unloading = [ [ 0, 0 ], [ 0.5, 0.75 ], [ 1, 1 ] ]: expected less stress than in loading"},
    {"curve_that_relaxes", "material = {weft_curve = [[0, 0], [1, 1]], quality = 10}", "a.toml: material.weft_curve: expected no quality, maxwell or series beside it"},
    {"maxwell_that_holds_nothing", "material.maxwell = [[1, 0.5], [10, 0.5]]", "a.toml:2: material.maxwell = [ [ 1, 0.5 ], [ 10, 0.5 ] ]: expected parts whose sum is below 1"},
    {"negative_rate", "material.maxwell = [[-1, 0.6]]", "a.toml:2: material.maxwell = -1: expected a number above 0"},
    {"two_kinds_of_relaxation", "material = {maxwell = [[1, 0.5]], quality = 10}", "a.toml: material.quality: expected one of quality, maxwell and series"},
    {"quality_too_low", "material = {quality = 0.3, band = [1, 1e6]}", "a.toml: material.quality: expected more than 0.3 for so wide a band"},
    {"band_of_one_frequency", "material.band = [5, 5]", "a.toml:2: material.band = [ 5, 5 ]: expected [lowest, highest]"},

    {"tables_of_nothing", "material.law = 'tables'", "a.toml:2: material.law = 'tables': expected a material.fabric or a material.stretch_table"},
    {"tables_with_a_curve", "material = {fabric = 'denim', shear_curve = [[0, 0], [1, 1]], law = 'tables'}", "a.toml:2: material.law = 'tables': expected no curves"},
    {"tables_that_relax", "material = {fabric = 'denim', law = 'tables', quality = 10}", "a.toml: material.law: expected no quality, maxwell or series beside it"},
    {"shear_curve_that_relaxes", "material = {shear_curve = [[0, 0], [1, 1]], quality = 10}", "a.toml: material.shear_curve: expected no quality, maxwell or series beside it"},
    {"tables_of_a_chain", "material = {fabric = 'denim', law = 'tables', bend_projected = false}\ngrid.n = [5, 1]", "a.toml: material.law: expected \"linear\", a chain has no quadrants"},
    {"table_of_five_rows", "material.stretch_table = [[1, 2, 3, 4], [1, 2, 3, 4], [1, 2, 3, 4], [1, 2, 3, 4], [1, 2, 3, 4]]", "a.toml:2: material.stretch_table = "},
    {"bend_curve_of_a_membrane", "material = {bend_form = 'membrane', weft_bend_curve = [[0, 0], [1, 1]]}", "a.toml:2: material.weft_bend_curve = [ [ 0, 0 ], [ 1, 1 ] ]: expected material.bend_form \"plate\""},
    {"shear_curve_as_printed", "material = {shear_form = 'printed', shear_curve = [[0, 0], [1, 1]]}", "a.toml:2: material.shear_curve = [ [ 0, 0 ], [ 1, 1 ] ]: expected material.shear_form \"conservative\""},
    {"viscous_survey", "material = {shear_damping = 1, shear_form = 'hinges'}", "a.toml: material.shear_damping: expected 0 beside a material.shear_form of the survey"},
    {"friction_that_feeds", "material.shear_friction = -1", "a.toml:2: material.shear_friction = -1: expected a number of at least 0"},
    {"friction_at_once", "material.bend_friction_onset = 0", "a.toml:2: material.bend_friction_onset = 0: expected a number above 0"},
    {"unknown_friction", "material.friction_law = 'coulomb'", "a.toml:2: material.friction_law = 'coulomb': expected one of \"dahl\", \"jenkin\""},
    {"chain_that_rests_curved", "rest.shape = 'start'\ngrid.n = [5, 1]", "a.toml: rest.shape: expected \"flat\", the curvature of a chain has no normal"},
    {"unknown_rest", "rest.shape = 'round'", "a.toml:2: rest.shape = 'round': expected one of \"flat\", \"start\""},

    {"one_particle", "[grid]\nn = 1", "a.toml:3: grid.n = 1: expected at least 2 particles"},
    {"one_by_one", "[grid]\nn = [1, 1]", "a.toml:3: grid.n = [ 1, 1 ]: expected at least 2 particles"},
    {"no_particles", "[grid]\nn = [0, 5]", "a.toml:3: grid.n = 0: " + count},
    {"negative_count", "[grid]\nn = -3", "a.toml:3: grid.n = -3: " + count},
    {"fractional_count", "[grid]\nn = 2.5", "a.toml:3: grid.n = 2.5: " + count},
    {"fractional_count_in_a_list", "[grid]\nn = [4, 3.0]", "a.toml:3: grid.n = 3.0: " + count},
    {"count_beyond_int", "[grid]\nn = 9999999999999", "a.toml:3: grid.n = 9999999999999: " + count},
    {"too_many_particles", "[grid]\nn = 4000", "a.toml:3: grid.n = 4000: expected at most ten million particles"},

    {"curved_piece_of_no_kind", "grid.lower = [{spline = [[0, 0], [1, 0]]}]", "a.toml:2: grid.lower.spline = "},
    {"curved_piece_of_two_kinds", "grid.lower = [{line = [[0, 0], [1, 0]], arc = [[0, 0], [1, 0], [0, 1]]}]", "a.toml:2: grid.lower = { arc = [ [ 0, 0 ], [ 1, 0 ], [ 0, 1 ] ], line = [ [ 0, 0 ], [ 1, 0 ] ] }: expected one of line, arc, bezier and polyline"},
    {"line_of_three_points", "grid.upper = [{line = [[0, 0], [1, 0], [2, 0]]}]", "a.toml:2: grid.upper.line = [ [ 0, 0 ], [ 1, 0 ], [ 2, 0 ] ]: expected 2 points"},
    {"bezier_of_two_points", "grid.left = [{bezier = [[0, 0], [1, 0]]}]", "a.toml:2: grid.left.bezier = [ [ 0, 0 ], [ 1, 0 ] ]: expected 3 to 6 points"},
    {"straight_arc", "grid.right = [{arc = [[0, 0], [1, 1], [2, 2]]}]", "a.toml:2: grid.right.arc = [ [ 0, 0 ], [ 1, 1 ], [ 2, 2 ] ]: expected three points that are not on one line"},
    {"line_of_one_point", "grid.lower = [{line = [[1, 1], [1, 1]]}]", "a.toml:2: grid.lower.line = [ [ 1, 1 ], [ 1, 1 ] ]: expected points that differ"},
    {"point_far_away", "grid.lower = [{line = [[0, 0], [1e9, 0]]}]", "a.toml:2: grid.lower.line = [ 1000000000.0, 0 ]: expected coordinates in metres"},
    {"gap_in_a_side", "grid.lower = [{line = [[0, 0], [1, 0]]}, {line = [[1.5, 0], [2, 0]]}]", "a.toml:2: grid.lower = { line = [ [ 1.5, 0 ], [ 2, 0 ] ] }: expected a piece that begins where the one before ends, at [1, 0]"},
    {"three_sides", "grid = {lower = [{line = [[0, 0], [1, 0]]}], right = [{line = [[1, 0], [1, 1]]}], left = [{line = [[0, 0], [0, 1]]}]}",
     "a.toml: grid.upper: expected all of lower, right, upper and left, or none"},
    {"open_outline", "grid = {lower = [{line = [[0, 0], [1, 0]]}], right = [{line = [[1, 0.1], [1, 1]]}], upper = [{line = [[0, 1], [1, 1]]}], left = [{line = [[0, 0], [0, 1]]}]}",
     "a.toml: grid.lower: expected to end where grid.right begins, at [1, 0.1], not at [1, 0]: the outline is open"},
    {"too_many_cells", "grid = {n = 4, lower = [{line = [[0, 0], [0.5, 0]], cells = 2}, {line = [[0.5, 0], [1, 0]], cells = 2}], right = [{line = [[1, 0], [1, 1]]}], upper = [{line = [[0, 1], [1, 1]]}], left = [{line = [[0, 0], [0, 1]]}]}",
     "a.toml: grid.lower: expected 3 cells on its pieces, as grid.n has, not 4"},
    {"cells_of_one_piece", "grid = {n = 4, lower = [{line = [[0, 0], [0.5, 0]], cells = 3}, {line = [[0.5, 0], [1, 0]]}], right = [{line = [[1, 0], [1, 1]]}], upper = [{line = [[0, 1], [1, 1]]}], left = [{line = [[0, 0], [0, 1]]}]}",
     "a.toml: grid.lower: expected cells of all of its pieces, or of none"},
    {"graded_cells", "grid = {n = 4, grading = [2, 1], lower = [{line = [[0, 0], [1, 0]], cells = 3}], right = [{line = [[1, 0], [1, 1]]}], upper = [{line = [[0, 1], [1, 1]]}], left = [{line = [[0, 0], [0, 1]]}]}",
     "a.toml: grid.lower: expected a grading of 1 beside cells of pieces"},
    {"cells_of_a_cut", "grid.cut = [{arc = [[1, 0], [0, 1], [-1, 0]], cells = 2}, {line = [[-1, 0], [1, 0]]}]", "a.toml: grid.cut: expected no cells"},
    {"no_cells", "grid.lower = [{line = [[0, 0], [1, 0]], cells = 0}]", "a.toml:2: grid.lower.cells = 0: expected a whole number"},
    {"cells_alone", "grid.lower = [{cells = 2}]", "a.toml:2: grid.lower = { cells = 2 }: expected one of line, arc, bezier and polyline in every piece"},
    {"clockwise_outline", "grid = {lower = [{line = [[0, 1], [1, 1]]}], right = [{line = [[1, 1], [1, 0]]}], upper = [{line = [[0, 0], [1, 0]]}], left = [{line = [[0, 1], [0, 0]]}]}",
     "a.toml: grid: its lines cross or touch at the cell [0, 0], near [0, 1]: expected lower, right, upper and left counterclockwise"},
    {"folded_outline", "grid = {n = 9, lower = [{arc = [[0, 0], [0.5, 1.5], [1, 0]]}], right = [{line = [[1, 0], [1, 1]]}], upper = [{line = [[0, 1], [1, 1]]}], left = [{line = [[0, 0], [0, 1]]}]}",
     "a.toml: grid: its lines cross or touch at the cell ["},
    {"graded_chain", "grid = {n = [5, 1], grading = [2, 1]}", "a.toml: grid: expected no sides, no cut and a grading of 1, a chain has equal spacings"},
    {"grading_of_one_spacing", "grid = {n = [5, 2], grading = [1, 3]}", "a.toml: grid.grading: expected 1 along lines of fewer than 3 particles"},
    {"steep_grading", "grid.grading = [1, 1001]", "a.toml:2: grid.grading = [ 1, 1001 ]: expected from 1/1000 to 1000"},
    {"printed_shear_of_a_panel", "grid = {n = 5, grading = 2}\nmaterial.shear_form = 'printed'", "a.toml: material.shear_form: expected \"conservative\""},
    {"printed_plate_of_a_panel", "grid = {n = 5, grading = 2}\nmaterial.bend_form = 'printed'", "a.toml: material.bend_form: expected \"plate\" or \"membrane\""},
    {"tables_of_a_panel", "grid = {n = 5, grading = 2}\nmaterial = {fabric = 'denim', law = 'tables'}", "a.toml: material.law: expected \"linear\", tables are those of a rectangle"},
    {"pleats_of_a_panel", "grid = {n = 9, grading = 2}\nstart.pleats = [1, 30]", "a.toml: start.pleats: expected 0 waves"},

    {"open_cut", "grid.cut = [{line = [[0, 0], [1, 0]]}, {line = [[1, 0], [1, 1]]}]", "a.toml: grid.cut: expected to end where it begins, at [0, 0], not at [1, 1]: the curve is open"},
    {"cut_that_crosses_itself", "grid.cut = [{line = [[0, 0], [1, 1]]}, {line = [[1, 1], [1, 0]]}, {line = [[1, 0], [0, 1]]}, {line = [[0, 1], [0, 0]]}]",
     "a.toml: grid.cut: expected a curve that does not cross itself"},
    {"cut_of_many_pieces", "grid.cut = [" + repeated(65, "{line = [[0, 0], [1, 0]]}, {line = [[1, 0], [0, 0]]}, ") + "]", "a.toml:2: grid.cut = "},
    {"cut_beside_the_grid", "grid.cut = [{arc = [[8, 0], [7, 1], [6, 0]]}, {line = [[6, 0], [8, 0]]}]", "a.toml: grid.cut: expected a curve with cloth inside, it lies beside the grid"},
    {"cut_of_a_chain", "grid = {n = [5, 1], cut = [{arc = [[1, 0], [0, 1], [-1, 0]]}, {line = [[-1, 0], [1, 0]]}]}", "a.toml: grid: expected no sides, no cut and a grading of 1, a chain has equal spacings"},
    {"cut_with_whole_cells", "grid = {border_cells = 'whole', cut = [{arc = [[1, 0], [0, 1], [-1, 0]]}, {line = [[-1, 0], [1, 0]]}]}", "a.toml: grid.border_cells: expected \"dual\" beside a cut"},
    {"membrane_of_a_cut", "grid.cut = [{arc = [[1, 0], [0, 1], [-1, 0]]}, {line = [[-1, 0], [1, 0]]}]\nmaterial.bend_form = 'membrane'", "a.toml: material.bend_form: expected \"plate\", a membrane"},

    {"circle_without_particles", "grid.n = 3\n[[pins]]\ncircle = [0.25, 0.25, 0.125]", "a.toml:4: pins.circle = [ 0.25, 0.25, 0.125 ]: expected a circle with particles of the grid inside"},
    {"circle_of_no_radius", "[[pins]]\ncircle = [0.5, 0.5, 0]", "a.toml:3: pins.circle = [ 0.5, 0.5, 0 ]: expected [x, y, radius] with a radius > 0"},
    {"pin_nowhere", "[[pins]]\ndirections = 'x'\nvelocity = [0, 0, 1]", "a.toml:2: pins = "},
    {"pin_twice", "[[pins]]\nwhere = 'all'\nparticles = [[0, 0]]", "a.toml:2: pins = "},
    {"pins_not_a_list", "[pins]\nwhere = 'all'\ndirections = 'x'", "a.toml:2: pins = "},
    {"unknown_place", "[[pins]]\nwhere = 'middle'", "a.toml:3: pins.where = 'middle': expected one of \"left edge\", \"right edge\", "},
    {"unknown_direction", "[[pins]]\nwhere = 'all'\ndirections = 'xw'",
     "a.toml:4: pins.directions = 'xw': expected some of the letters x, y and z"},
    {"no_direction", "[[pins]]\nwhere = 'all'\ndirections = ''",
     "a.toml:4: pins.directions = '': expected some of the letters x, y and z"},
    {"direction_twice", "[[pins]]\nwhere = 'all'\ndirections = 'xx'", "a.toml:4: pins.directions = 'xx': expected some of "},
    {"direction_of_no_length", "[[pins]]\nwhere = 'all'\ndirection = [0, 0, 0]",
     "a.toml:4: pins.direction = [ 0, 0, 0 ]: expected [x, y, z], not all of them 0"},
    {"direction_beside_directions", "[[pins]]\nwhere = 'all'\ndirection = [1, 1, 0]\ndirections = 'x'",
     "a.toml:2: pins = direction = [ 1, 1, 0 ] directions = 'x' where = 'all': expected 'direction' or 'directions' in a pin, not both"},
    {"infinite_velocity", "[[pins]]\nwhere = 'all'\nvelocity = [0, 0, inf]", "a.toml:4: pins.velocity = inf: expected a finite number"},
    {"pinned_particle_off_the_grid", "[grid]\nn = [4, 3]\n[[pins]]\nparticles = [[3, 2], [4, 0]]",
     "a.toml:5: pins.particles = [ [ 3, 2 ], [ 4, 0 ] ]: expected places [a, b] with 0 ≤ a < 4 and 0 ≤ b < 3"},
    {"pinned_particle_off_the_grid_after_many", "pins = [{particles = [" + repeated(50, "[0, 1], ") + "[9, 9]]}]",
     "a.toml:2: pins.particles = "},
    {"negative_pinned_particle", "[[pins]]\nparticles = [[0, -1]]", "a.toml:3: pins.particles = [ [ 0, -1 ] ]: expected places [a, b]"},
    {"half_a_pinned_particle", "[[pins]]\nparticles = [[0.5, 0]]", "a.toml:3: pins.particles = [ [ 0.5, 0 ] ]: expected places [a, b]"},
    {"pinned_particle_beyond_int", "[[pins]]\nparticles = [[1e300, 0]]", "a.toml:3: pins.particles = "},
    {"pinned_particle_of_three", "[[pins]]\nparticles = [[0, 0, 0]]", "a.toml:3: pins.particles = [ 0, 0, 0 ]: expected a list of 2"},

    {"obstacle_without_a_shape", "obstacles = [{radius = 1}]", "a.toml:2: obstacles = { radius = 1 }: expected 'shape' in every obstacle"},
    {"unknown_shape", "[[obstacles]]\nshape = 'cone'",
     "a.toml:3: obstacles.shape = 'cone': expected one of \"plane\", \"sphere\", \"box\", \"cylinder\", \"mannequin\", \"mesh\""},
    {"obstacle_that_is_none", "obstacles = ['sphere']", "a.toml:2: obstacles = 'sphere': expected a table"},
    {"unknown_key_in_an_obstacle", "[[obstacles]]\nshape = 'plane'\nheigth = 1", "a.toml:4: obstacles.heigth = 1: expected no such key; "},
    {"key_of_another_shape", "[[obstacles]]\nshape = 'sphere'\nradius = 1\nheight = 2",
     "a.toml:5: obstacles.height = 2: expected no such key; a sphere has shape, radius, vertices, friction, position, rotation, motion"},
    {"sphere_without_radius", "obstacles = [{shape = 'sphere'}]", "a.toml:2: obstacles = { shape = 'sphere' }: expected 'radius' in every sphere"},
    {"cylinder_without_height", "obstacles = [{shape = 'cylinder', radius = 1}]",
     "a.toml:2: obstacles = { radius = 1, shape = 'cylinder' }: expected 'height' in every cylinder"},
    {"box_without_size", "obstacles = [{shape = 'box'}]", "a.toml:2: obstacles = { shape = 'box' }: expected 'size' in every box"},
    {"mesh_without_file", "obstacles = [{shape = 'mesh'}]", "a.toml:2: obstacles = { shape = 'mesh' }: expected 'file' in every mesh"},
    {"flat_box", "obstacles = [{shape = 'box', size = [1, 0, 1]}]", "a.toml:2: obstacles.size = 0: expected a number above 0"},
    {"sphere_inside_out", "obstacles = [{shape = 'sphere', radius = -1}]", "a.toml:2: obstacles.radius = -1: expected a number above 0"},
    {"legs_too_far_apart", "obstacles = [{shape = 'mannequin', legs = 45}]", "a.toml:2: obstacles.legs = 45: expected an angle of at most 30 degrees"},
    {"arms_over_the_head", "obstacles = [{shape = 'mannequin', arms = 120}]",
     "a.toml:2: obstacles.arms = 120: expected an angle with the vertical of at most 90 degrees"},
    {"negative_friction", "obstacles = [{shape = 'plane', friction = -1}]",
     "a.toml:2: obstacles.friction = -1: expected a number of at least 0"},
    {"position_and_motion", "obstacles = [{shape = 'plane', position = [0, 0, 1], motion = [{time = 0}]}]",
     "a.toml:2: obstacles = { motion = [ { time = 0 } ], position = [ 0, 0, 1 ], shape = 'plane' }: expected 'motion' or 'position' and 'rotation', not both"},
    {"motion_of_no_frame", "obstacles = [{shape = 'plane', motion = []}]", "a.toml:2: obstacles.motion = []: expected at least one key frame"},
    {"motion_back_in_time", "obstacles = [{shape = 'plane', motion = [{time = 1}, {time = 1}]}]",
     "a.toml:2: obstacles.motion = [ { time = 1 }, { time = 1 } ]: expected key frames with times that ascend"},
    {"key_frame_without_time", "obstacles = [{shape = 'plane', motion = [{position = [0, 0, 1]}]}]",
     "a.toml:2: obstacles.motion = { position = [ 0, 0, 1 ] }: expected 'time' in every key frame"},
    {"unknown_key_in_a_key_frame", "obstacles = [{shape = 'plane', motion = [{time = 0, velocity = [0, 0, 1]}]}]",
     "a.toml:2: obstacles.motion.velocity = [ 0, 0, 1 ]: expected no such key; a key frame has time, position, rotation"},
    {"no_contact_distance", "contact.distance = 0", "a.toml:2: contact.distance = 0: expected a number above 0"},
    {"relaxation_above_two", "contact.relaxation = 2.5", "a.toml:2: contact.relaxation = 2.5: expected a number above 0 and at most 2"},
    {"no_relaxation", "contact.relaxation = 0", "a.toml:2: contact.relaxation = 0: expected a number above 0"},
    {"unknown_response", "contact.response = 'spring'",
     "a.toml:2: contact.response = 'spring': expected one of \"constraint\", \"reaction\", \"penalty\", \"field\", \"reposition\", \"reflect\", \"impulse\", \"alteration\""},
    {"unknown_detection", "contact.detection = 'rays'",
     "a.toml:2: contact.detection = 'rays': expected one of \"half-spaces\", \"ray\""},
    {"restitution_above_one", "contact.restitution = 1.5", "a.toml:2: contact.restitution = 1.5: expected a number from 0 to 1"},
    {"no_reaction_time", "contact.reaction_time = 0", "a.toml:2: contact.reaction_time = 0: expected a number above 0"},

    {"nothing_free_to_move", "[[pins]]\nwhere = 'all'", "a.toml: pins: expected at least one coordinate that is free to move"},
    {"contraction_above_tension", "material.tension = [4, 9]\nmaterial.contraction = 6",
     "a.toml: material.contraction: expected C12² below k1 k2, or the material would collapse"},
    {"contraction_without_tension", "material.contraction = 1", "a.toml: material.contraction: expected C12² below k1 k2"},
    {"projected_plate_on_a_chain", "grid.n = [5, 1]\nmaterial.bend = 1", "a.toml: material.bend: " + chain_bends},
    {"membrane_on_a_chain", "grid.n = [1, 5]\nmaterial.bend_damping = 1\nmaterial.bend_form = 'membrane'",
     "a.toml: material.bend: " + chain_bends},
    {"wind_on_a_chain", "grid.n = [5, 1]\nforces.wind = [0, 1, 0]",
     "a.toml: forces.wind: expected forces.drag = forces.lift, a chain has no normals"},
    {"air_on_a_chain", "grid.n = [1, 5]\nforces.air = 1", "a.toml: forces.air: expected 0, a chain has no normals"},
    {"negative_air", "forces.air = -1", "a.toml:2: forces.air = -1: expected a number of at least 0"},
    {"half_a_pleat", "start.pleats = [1.5, 40]", "a.toml:2: start.pleats = [ 1.5, 40 ]: expected a whole number of at most 0 waves"},
    {"more_pleats_than_particles", "grid.n = 9\nstart.pleats = [5, 40]",
     "a.toml:3: start.pleats = [ 5, 40 ]: expected a whole number of at most 4 waves, for two edges each"},
    {"pleats_that_turn_back", "grid.n = 9\nstart.pleats = [1, 90]",
     "a.toml:3: start.pleats = [ 1, 90 ]: expected a whole number of at most 4 waves, for two edges each, and an angle below 90"},
    {"unprojected_membrane", "[material]\nbend = 1\nbend_form = 'membrane'\nbend_projected = false",
     "a.toml: material.bend_projected = false: expected true, the membrane acts along the normal only"},

    {"override_of_an_unknown_key", "", "--set material.densty: unknown key 'material.densty' (did you mean material.density?): expected one of material.fabric, material.density, ",
     "material.densty=1"},
    {"override_of_an_unknown_section", "", "--set foo: unknown key 'foo': expected one of name, ", "foo=1"},
    {"override_inside_a_value", "grid = 5", "--set grid.n: 'grid' is not a section", "grid.n=4"},
    {"override_below_a_key", "", "--set name.x: unknown key 'name.x' (did you mean name?): expected one of name, ", "name.x=1"},
    {"override_by_a_negative_density", "material.density = 1",
     "--set material.density: material.density = -1: expected a number above 0", "material.density=-1"},
    {"override_by_not_a_number", "", "--set end.time: end.time = nan: expected a finite number", "end.time=nan"},
    {"override_by_a_word", "", "--set material.shear: material.shear = 'stiff': expected a number", "material.shear=stiff"},
    {"override_by_a_broken_list", "", "--set material.tension: material.tension = '[1,': expected a number", "material.tension=[1,"},
    {"override_by_one_particle", "", "--set grid.n: grid.n = 1: expected at least 2 particles", "grid.n=1"},
    {"override_by_an_unknown_place", "", "--set pins: pins.where = 'middle': expected one of ", "pins=[{where='middle'}]"},
};
// clang-format on

class RefusedScene : public testing::TestWithParam<BadScene> {};
INSTANTIATE_TEST_SUITE_P(, RefusedScene, testing::ValuesIn(bad_scenes), [](const auto& test) { return test.param.name; });

TEST_P(RefusedScene, SaysInOneLineWhereWhatAndWhatIsRight) {
  const BadScene& bad = GetParam();
  std::vector<model::Override> overrides;
  if (!bad.set.empty()) overrides.push_back(model::parse_override(bad.set));
  EXPECT_THAT(message([&] { model::parse_scene("name = 'x'\n" + bad.lines, "a.toml", overrides); }),
              AllOf(StartsWith(bad.says), Not(HasSubstr("\n"))));
}

TEST(SceneError, OfASceneWithoutAName) {
  EXPECT_EQ(message([&] { model::parse_scene("name = ''", "a.toml"); }), "a.toml: name: expected a name for the scene");
  for (const std::string text : {"", "# nothing\n", "[grid]\nn = 3"})
    EXPECT_EQ(message([&] { model::parse_scene(text, "no file"); }), "no file: name: expected a name for the scene");
}

TEST(SceneError, OfAnUnknownSceneSaysTheNamesOfAll) {
  const std::string said = message([] { load_scene("hung-egde"); });
  EXPECT_THAT(said, AllOf(StartsWith("unknown scene 'hung-egde' (did you mean hung-edge?): expected "),
                          HasSubstr("or a file: a scene (.toml), a mesh (.obj, .ply)")));
  for (const auto& scene : model::builtin_scenes()) EXPECT_THAT(said, HasSubstr(std::string(scene.name)));
}

TEST(SceneError, OfAFileThatCannotBeRead) {
  const base::TemporaryFolder folder;
  const std::string missing = folder / "missing.toml", directory = folder / "directory.toml";
  std::filesystem::create_directory(directory);
  EXPECT_EQ(message([&] { load_scene(missing); }), missing + ": there is no such file: expected a scene file of at most 4 MB");
  EXPECT_EQ(message([&] { load_scene(directory); }), directory + ": is a folder: expected a scene file of at most 4 MB");
}

TEST(SceneError, InAFileSaysItsName) {
  const base::TemporaryFolder folder;
  const std::string file = folder / "bad.toml";
  std::ofstream(file) << "name = 'x'\nfoo = 1\n";
  EXPECT_THAT(message([&] { load_scene(file); }), StartsWith(file + ":2: unknown key 'foo'"));
}

TEST(SceneError, OfAnOverrideWithoutKeyOrValue) {
  for (const std::string text : {"material.damping", "=3", "material.damping="})
    EXPECT_EQ(message([&] { model::parse_override(text); }),
              "--set " + text + ": expected key=value, for example material.damping=0.5");
}

}  // namespace
}  // namespace drape::verify::scene_error_test
