#include "bench/report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "bench/report/base64.hpp"
#include "bench/report/embedded.hpp"
#include "bench/report/obstacles.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/analysis/runs_table.hpp"
#include "results/analysis/work_precision.hpp"
#include "results/file/schema.hpp"
#include "results/verdict.hpp"
#include "solver/linear/preconditioner.hpp"
#include "solver/methods.hpp"
#include "solver/options.hpp"

namespace drape::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_steps_shown = 500;  // of a run: more than a figure has pixels for would only make the page larger

Json json_value(double value) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;  // NaN becomes null
}
Json json_value(std::int64_t value) { return value; }
Json json_value(int value) { return value; }
Json json_value(const std::string& value) { return value; }
Json json_value(const results::Verdict& verdict) { return to_string(verdict); }
Json json_value(solver::Outcome outcome) { return std::string(to_string(outcome)); }
Json json_value(std::monostate) { return nullptr; }
Json json_value(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(json_value(value));
  return list;
}

template <class Fields, class Record>
void put_fields(Json& object, const Fields& fields, const Record& record) {
  results::for_each(fields, [&](const auto& field) { object[field.name] = json_value(record.*field.member); });
}

/// Whether each cell of a column of verdicts says that something is not as it was wanted.
Json page_missed(const results::Column& verdicts) {
  Json missed = Json::array();
  for (std::size_t row = 0; row < verdicts.cells.size(); ++row)
    missed.push_back(results::standing(text_in(&verdicts, row)) == results::Standing::missed);
  return missed;
}

Json page_column(const results::Column& column) {
  Json cells = Json::array();
  for (const results::Datum& cell : column.cells)
    cells.push_back(std::visit([](const auto& value) { return json_value(value); }, cell));
  Json object{{"name", column.name},
              {"title", column.title},
              {"unit", column.unit},
              {"description", column.description},
              {"numeric", !column.unit.empty()},
              {"role", std::string(to_string(column.role))},
              {"group", column.group},
              {"part", std::string(to_string(column.part))},
              {"classes", column.classes}};
  object["cells"] = std::move(cells);
  if (!column.shown.empty()) object["shown"] = column.shown;
  if (column.role == results::Role::verdict) object["missed"] = page_missed(column);
  return object;
}

/// A list for each quantity; long runs are thinned to equidistant steps and the last.
Json page_steps(const std::vector<results::StepRecord>& steps) {
  const std::size_t stride = (steps.size() + most_steps_shown - 1) / most_steps_shown;
  Json object{{"every", stride}};
  results::for_each(results::step_fields, [&](const auto& field) {
    Json list = Json::array();
    for (std::size_t k = 0; k < steps.size(); k += stride) list.push_back(json_value(steps[k].*field.member));
    if (stride > 1 && (steps.size() - 1) % stride > 0) list.push_back(json_value(steps.back().*field.member));
    object[field.name] = std::move(list);
  });
  return object;
}

/// Positions frame by frame, particle by particle, x, y, z, as 32-bit numbers: the player needs no more.
std::string packed_positions(const std::vector<solver::State>& states) {
  std::vector<float> numbers;
  for (const solver::State& state : states)
    for (Eigen::Index i = 0; i < state.x.rows(); ++i)
      for (Eigen::Index c = 0; c < state.x.cols(); ++c) numbers.push_back(static_cast<float>(state.x(i, c)));
  return base64(std::as_bytes(std::span(numbers)));
}

/// What each particle is, a byte each: frame by frame, or once if that never changes.
std::string packed_constraints(const std::vector<std::vector<int>>& frames) {
  const bool same = std::ranges::all_of(frames, [&](const std::vector<int>& frame) { return frame == frames.front(); });
  std::vector<std::byte> bytes;
  for (const std::vector<int>& frame : std::span(frames).first(same ? 1 : frames.size()))
    for (const int kind : frame) bytes.push_back(static_cast<std::byte>(kind));
  return base64(bytes);
}

Json page_trajectory(const results::RunRecord& run, Json& surfaces) {
  const results::TrajectoryRecord& trajectory = *run.trajectory;
  return {{"nu", trajectory.nu},
          {"nv", trajectory.nv},
          {"panels", trajectory.panels.empty() ? Json{{trajectory.nu, trajectory.nv}} : Json(trajectory.panels)},
          {"times", trajectory.times},
          {"positions", packed_positions(trajectory.states)},
          {"constraint", packed_constraints(trajectory.constraint)},
          {"trim", page_trim(run)},
          {"refined", page_refined(run)},
          {"obstacles", page_obstacles(run, surfaces)}};
}

Json page_run(const results::RunRecord& run, Json& surfaces) {
  Json object;
  put_fields(object, results::run_fields, run);
  object["succeeded"] = run.outcome == solver::Outcome::success;
  if (!run.times_ms.empty()) {
    const auto [lower, median, upper] = results::quartiles(run.times_ms);
    object["time"] = {{"lower", lower}, {"median", median}, {"upper", upper}};
  }
  for (const results::WorkCount& work : run.work) object["work"][work.name] = work.count;
  object["steps"] = page_steps(run.steps);
  if (run.error) {
    put_fields(object["error"], results::error_fields, *run.error);
    object["error"]["comparable"] = results::comparable(*run.error);
    object["error"]["resolved"] = results::resolved(*run.error);
  }
  if (run.motion_error) put_fields(object["motion_error"], results::motion_error_fields, *run.motion_error);
  if (run.contact) put_fields(object["contact"], results::contact_fields, *run.contact);
  if (run.trajectory) object["trajectory"] = page_trajectory(run, surfaces);
  return object;
}

Json page_provenance(const results::Provenance& provenance) {
  Json facts = Json::array();
  for (const results::Fact& fact : provenance)
    facts.push_back({{"name", fact.name}, {"value", fact.value}, {"description", fact.description}});
  return facts;
}

/// JSON inside a <script>: no text in it can end the element.
std::string script_data(const nlohmann::ordered_json& data) {
  std::string safe;
  for (const char c : data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace))
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  return safe;
}

bool has_trajectory(const nlohmann::ordered_json& file) {
  return std::ranges::any_of(file["runs"], [](const auto& run) { return run.contains("trajectory"); });
}

void add_script(std::string& page, std::string_view script) {
  page.append("<script>\n").append(script).append("\n</script>\n");
}

/// A table of the page.
Json page_table(const results::Table& table) {
  Json columns = Json::array();
  for (const results::Column& column : table.columns) columns.push_back(page_column(column));
  return {{"name", table.name},
          {"description", table.description},
          {"figure", std::string(to_string(table.figure))},
          {"for_file", table.for_file},
          {"columns", std::move(columns)}};
}

/// What the program's own tables say of the names of methods and solvers, and of the scenes that were run.
Json page_words(std::span<const results::Recording> recordings) {
  Json words = Json::array();
  const auto add = [&](std::string_view name, std::string_view says) {
    words.push_back({{"word", std::string(name)}, {"says", std::string(says)}});
  };
  for (const solver::Method& method : solver::methods()) add(method.name, method.description);
  for (const solver::StageKind& kind : solver::stage_kinds()) add(kind.name, kind.description);
  for (const solver::LinearSolver& linear : solver::linear_solvers()) add(linear.name, linear.description);
  const auto is_run = [&](std::string_view scene) {
    return std::ranges::any_of(recordings, [&](const results::Recording& recording) {
      return std::ranges::find(recording.runs, scene, &results::RunRecord::scene) != recording.runs.end();
    });
  };
  for (const model::BuiltinScene& scene : model::builtin_scenes())
    if (is_run(scene.name)) add(scene.name, model::parse_scene(scene.toml, scene.name).description);
  return words;
}

/// All that a report shows of one HDF5 file: its provenance, its tables, a table of its runs, and of each run its fields, steps
/// (at most 500 of them, evenly chosen), errors and trajectory, whose obstacles have the surfaces of a list that the runs
/// share. Numbers that are not finite are null (NaN) or the texts "inf" and "-inf", which JSON has no numbers for.
Json page_data(const std::string& name, const results::Recording& recording) {
  const auto& [provenance, runs, tables] = recording;
  Json data{{"file", name}, {"provenance", page_provenance(provenance)}};
  data["tables"] = Json::array();
  for (const results::Table& table : tables) data["tables"].push_back(page_table(table));
  data["runs"] = Json::array();
  data["surfaces"] = Json::array();
  for (const results::RunRecord& run : runs) data["runs"].push_back(page_run(run, data["surfaces"]));
  if (!runs.empty()) data["runs_table"] = page_table(results::to_table(runs));
  return data;
}

}  // namespace

std::string report_page(std::span<const std::string> names, std::span<const results::Recording> recordings,
                        std::span<const results::Table> overview) {
  nlohmann::ordered_json data{{"files", nlohmann::ordered_json::array()}, {"overview", nlohmann::ordered_json::array()}};
  for (std::size_t k = 0; k < names.size(); ++k) data["files"].push_back(page_data(names[k], recordings[k]));
  for (const results::Table& table : overview) data["overview"].push_back(page_table(table));
  data["words"] = page_words(recordings);

  std::string page(embedded::head_html);
  page.append("<style>\n").append(embedded::style_css).append("</style>\n").append(embedded::body_html);
  page.append(fmt::format("<script type=\"application/json\" id=\"data\">{}</script>\n", script_data(data)));
  add_script(page, embedded::plotly_js);
  if (std::ranges::any_of(data["files"], has_trajectory)) {
    add_script(page, embedded::three_js);
    add_script(page, embedded::orbit_controls_js);
  }
  add_script(page, embedded::report_js);
  return page + "</html>\n";
}

}  // namespace drape::bench
