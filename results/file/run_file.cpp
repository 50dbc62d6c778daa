#include "results/file/run_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <system_error>
#include <utility>

#include "results/file/dimensions.hpp"
#include "results/file/hdf5.hpp"
#include "results/file/schema.hpp"
#include "results/file/schema_4.hpp"
#include "results/file/table_in_file.hpp"
#include "results/file/trajectory_in_file.hpp"

namespace drape::results {
namespace fs = std::filesystem;
namespace {

using hdf5::Handle;

/// Runs `action` and names the file in its errors.
template <class Action>
auto with_file_named(const fs::path& path, Action action) {
  try {
    return action();
  } catch (const hdf5::Error& error) {
    throw base::FileError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

// --- Members of records by their type ------------------------------------------------------------------------------------

void write(const Handle& group, const auto& field, const std::string& value) {
  hdf5::write_described_text(group, field.name, value, field.description);
}

void write(const Handle& group, const auto& field, double value) {
  hdf5::write_numbers(group, field.name, &value, {}, field.unit, field.description);
}

template <class Number>
void write(const Handle& group, const auto& field, const std::vector<Number>& values) {
  hdf5::write_numbers(group, field.name, values.data(), {values.size()}, field.unit, field.description);
}

void write(const Handle& group, const auto& field, solver::Outcome outcome) {
  hdf5::write_described_text(group, field.name, std::string(to_string(outcome)), field.description);
}

void write(const Handle& group, const auto& field, const solver::Vectors& values) {
  const auto rows = static_cast<std::uint64_t>(values.rows());
  hdf5::write_numbers(group, field.name, values.data(), {rows, 3}, field.unit, field.description);
}

void write(const Handle& group, const auto& field, const Eigen::VectorXd& values) {
  hdf5::write_numbers(group, field.name, values.data(), {static_cast<std::uint64_t>(values.size())}, field.unit,
                      field.description);
}

void read(const Handle& group, const char* name, std::string& value) { value = hdf5::read_text(group, name); }

void read(const Handle& group, const char* name, solver::Outcome& outcome) {
  const std::string text = hdf5::read_text(group, name);
  const auto known = solver::outcome_named(text);
  if (!known) throw hdf5::Error(fmt::format("{} is '{}', which this program does not know", name, text));
  outcome = *known;
}

void read(const Handle& group, const char* name, double& value) { value = hdf5::read_number<double>(group, name); }

void read(const Handle& group, const char* name, std::vector<double>& values) {
  values = hdf5::read_numbers<double>(group, name);
}

void read(const Handle& group, const char* name, solver::Vectors& values) {
  const auto numbers = hdf5::read_numbers<double>(group, name);
  if (numbers.size() % 3 != 0) throw hdf5::Error(fmt::format("{} must have three columns", name));
  values = Eigen::Map<const solver::Vectors>(numbers.data(), static_cast<Eigen::Index>(numbers.size() / 3), 3);
}

void read(const Handle& group, const char* name, Eigen::VectorXd& values) {
  const auto numbers = hdf5::read_numbers<double>(group, name);
  values = Eigen::Map<const Eigen::VectorXd>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

template <class Record>
void write_fields(const Handle& group, const auto& fields, const Record& record) {
  for_each(fields, [&](const auto& field) { write(group, field, record.*field.member); });
}

template <class Record>
Record read_fields(const Handle& group, const auto& fields) {
  Record record;
  for_each(fields, [&](const auto& field) { read(group, field.name, record.*field.member); });
  return record;
}

void write_state(const Handle& group, const solver::State& y) {
  write_fields(group, state_fields, y);
  if (y.z.size() > 0) write(group, memory_field, y.z);
  write_particle_scales(group, static_cast<std::uint64_t>(y.x.rows()));
}

solver::State read_state(const Handle& group) {
  auto y = read_fields<solver::State>(group, state_fields);
  if (hdf5::has(group, memory_field.name)) read(group, memory_field.name, y.z);
  return y;
}

void write_steps(const Handle& group, const std::vector<StepRecord>& steps) {
  for_each(step_fields, [&]<class Value>(const Field<StepRecord, Value>& field) {
    std::vector<Value> column;
    std::ranges::transform(steps, std::back_inserter(column), field.member);
    write(group, field, column);
  });
}

std::vector<StepRecord> read_steps(const Handle& group) {
  std::vector<StepRecord> steps(hdf5::read_numbers<double>(group, std::get<0>(step_fields).name).size());
  for_each(step_fields, [&]<class Value>(const Field<StepRecord, Value>& field) {
    const auto column = hdf5::read_numbers<Value>(group, field.name);
    if (column.size() != steps.size()) throw hdf5::Error(fmt::format("{} must be as long as the other series", field.name));
    for (std::size_t i = 0; i < column.size(); ++i) steps[i].*field.member = column[i];
  });
  return steps;
}

void write_scene_keys(const Handle& group, const std::vector<SceneValue>& keys) {
  for_each(scene_key_fields, [&](const auto& field) {
    std::vector<std::string> column;
    std::ranges::transform(keys, std::back_inserter(column), field.member);
    hdf5::write_texts(group, field.name, column, field.description);
  });
}

std::vector<SceneValue> read_scene_keys(const Handle& group) {
  std::vector<SceneValue> keys(hdf5::read_texts(group, std::get<0>(scene_key_fields).name).size());
  for_each(scene_key_fields, [&](const auto& field) {
    const std::vector<std::string> column = hdf5::read_texts(group, field.name);
    if (column.size() != keys.size()) throw hdf5::Error(fmt::format("{} must be as long as the other columns", field.name));
    for (std::size_t i = 0; i < column.size(); ++i) keys[i].*field.member = column[i];
  });
  return keys;
}

// --- Runs ----------------------------------------------------------------------------------------------------------------

void write_run(const Handle& runs, const std::string& name, const RunRecord& run) {
  const Handle group = hdf5::create_group(runs, name, "one run of one method on one scene");
  write_fields(group, run_fields, run);
  write_scene_keys(hdf5::create_group(group, "scene_keys", "the complete scene, key by key"), run.scene_keys);
  write_steps(hdf5::create_group(group, "steps", "what happened in each accepted step"), run.steps);
  const Handle parameters = hdf5::create_group(group, "parameters", "parameters of the scene");
  for (const Parameter& p : run.parameters) hdf5::write_numbers(parameters, p.name, &p.value, {}, p.unit, p.description);
  const Handle work = hdf5::create_group(group, "work", "how often each kind of work was done");
  for (const WorkCount& w : run.work) hdf5::write_numbers(work, w.name, &w.count, {}, "1", w.description);
  write_state(hdf5::create_group(group, "final_state", "where the run ended"), run.final_state);
  if (run.choice)
    write_fields(hdf5::create_group(group, "choice", "why the program chose method and step"), choice_fields, *run.choice);
  if (run.error)
    write_fields(hdf5::create_group(group, "error", "distance of the final positions from a reference"), error_fields,
                 *run.error);
  if (run.motion_error)
    write_fields(hdf5::create_group(group, "motion_error", "largest distances from a reference during the run"),
                 motion_error_fields, *run.motion_error);
  if (run.contact) write_fields(hdf5::create_group(group, "contact", "what obstacles did"), contact_fields, *run.contact);
  if (run.trajectory) write_trajectory(group, *run.trajectory);
  name_dimensions_of_run(group);
}

RunRecord read_run(const Handle& group) {
  RunRecord run = read_fields<RunRecord>(group, run_fields);
  run.scene_keys =
      hdf5::has(group, "scene_keys") ? read_scene_keys(hdf5::open_group(group, "scene_keys")) : keys_in(run.scene_toml);
  run.steps = read_steps(hdf5::open_group(group, "steps"));
  const Handle parameters = hdf5::open_group(group, "parameters");
  for (const auto& [name, unit, description] : hdf5::datasets(parameters))
    run.parameters.push_back({name, hdf5::read_number<double>(parameters, name), unit, description});
  const Handle work = hdf5::open_group(group, "work");
  for (const auto& [name, unit, description] : hdf5::datasets(work))
    run.work.push_back({name, description, hdf5::read_number<std::int64_t>(work, name)});
  run.final_state = read_state(hdf5::open_group(group, "final_state"));
  if (hdf5::has(group, "choice")) run.choice = read_fields<ChoiceRecord>(hdf5::open_group(group, "choice"), choice_fields);
  if (hdf5::has(group, "error")) run.error = read_fields<ErrorRecord>(hdf5::open_group(group, "error"), error_fields);
  if (hdf5::has(group, "motion_error"))
    run.motion_error = read_fields<MotionErrorRecord>(hdf5::open_group(group, "motion_error"), motion_error_fields);
  if (hdf5::has(group, "contact")) run.contact = read_fields<ContactRecord>(hdf5::open_group(group, "contact"), contact_fields);
  if (hdf5::has(group, "trajectory")) run.trajectory = read_trajectory(group);
  return run;
}

// --- Files ---------------------------------------------------------------------------------------------------------------

int version_of(const Handle& file) { return hdf5::read_integer(file, "schema_version"); }

void require_version(const Handle& file, int oldest) {
  const int version = version_of(file);
  if (version < oldest || version > schema_version)
    throw hdf5::Error(
        fmt::format("its schema_version is {}, this program reads {} to {}", version, oldest_readable_version, schema_version));
}

Handle open_run_file(const fs::path& path) {
  Handle file = hdf5::open_for_reading(path);
  require_version(file, oldest_readable_version);
  return file;
}

std::vector<RunRecord> runs_of(const Handle& file) {
  const Handle runs = hdf5::open_group(file, "runs");
  std::vector<RunRecord> records;
  for (std::size_t i = 0; hdf5::has(runs, run_name(i)); ++i) records.push_back(read_run(hdf5::open_group(runs, run_name(i))));
  return records;
}

std::vector<Table> tables_of(const Handle& file) {
  const Handle tables = hdf5::open_group(file, "tables");
  std::vector<Table> result;
  for (const std::string& name : hdf5::groups(tables)) result.push_back(read_table(tables, name, version_of(file)));
  return result;
}

Provenance facts_of(const Handle& file) {
  Provenance facts;
  for (const std::string& name : hdf5::described_texts(file))
    facts.push_back({name, hdf5::read_text(file, name), hdf5::read_description(file, name)});
  return facts;
}

/// An empty file.
Handle begin(const Provenance& provenance) {
  Handle file = hdf5::create_in_memory();
  hdf5::write_text(file, "description", "Runs of drape, a harness for time integrators of cloth");
  hdf5::write_integer(file, "schema_version", schema_version);
  for (const Fact& fact : provenance) hdf5::write_described_text(file, fact.name, fact.value, fact.description);
  hdf5::write_described_text(file, "resumed", "", "UTC times of later starts that continued this file");
  hdf5::write_described_text(file, "finished", "", "UTC time of the end; empty: more was to come");
  hdf5::create_group(file, "runs", "one group for each run, in the order of the sweep");
  hdf5::create_group(file, "tables", "one group for each table of a study, one dataset for each column");
  return file;
}

/// What a process before this one has left. What others have added would be lost with the next image.
Handle go_on(const fs::path& path, const Provenance& provenance) {
  auto [file, added, altered] = hdf5::open_with_changes(path);
  require_version(file, schema_version);
  if (!added.empty() || !altered.empty())
    throw hdf5::Error(fmt::format("cannot be continued: another program has changed {}; choose another --out",
                                  added.empty() ? altered.front() : added.front()));
  if (const std::string why = why_not_resumed(facts_of(file), provenance); !why.empty())
    throw hdf5::Error(fmt::format("cannot be continued: {}; choose another --out", why));
  name_dimensions(file);  // which were not in what was copied
  return std::move(file);
}

}  // namespace

std::string run_name(std::size_t run) { return fmt::format("{:03}", run); }

struct RunFile::Image {
  Handle file;
  Handle runs, tables;
  std::size_t run_count = 0;
  bool published = false;

  explicit Image(Handle&& opened)
      : file(std::move(opened)), runs(hdf5::open_group(file, "runs")), tables(hdf5::open_group(file, "tables")) {
    while (hdf5::has(runs, run_name(run_count))) ++run_count;
  }

  /// Changes the file and publishes it; if that fails, undoes the change.
  void change(const fs::path& path, const auto& apply, const auto& undo) {
    with_file_named(path, [&] {
      try {
        apply();
        base::publish(path, hdf5::image(file), published ? base::Existing::replace : base::Existing::refuse);
        published = true;
      } catch (...) {
        undo();
        throw;
      }
    });
  }
};

RunFile::RunFile(fs::path path, const Provenance& provenance, Start start) : path_(std::move(path)) {
  std::error_code unknown;  // left to require_creatable
  const bool goes_on = start == Start::resumed && fs::exists(path_, unknown);
  if (!goes_on) base::require_creatable(path_);
  with_file_named(path_, [&] {
    image_ = std::make_unique<Image>(goes_on ? go_on(path_, provenance) : begin(provenance));
    image_->published = goes_on;
  });
}

RunFile::~RunFile() = default;

void RunFile::add(std::span<const RunRecord> runs) {
  Image& image = *image_;
  const auto name = [&](std::size_t k) { return run_name(image.run_count + k); };
  image.change(
      path_,
      [&] {
        for (std::size_t k = 0; k < runs.size(); ++k) write_run(image.runs, name(k), runs[k]);
      },
      [&] {
        for (std::size_t k = 0; k < runs.size(); ++k)
          if (hdf5::has(image.runs, name(k))) hdf5::remove(image.runs, name(k));
      });
  image.run_count += runs.size();
}

void RunFile::add(const Table& table) {
  const Handle& tables = image_->tables;
  image_->change(
      path_, [&] { write_table(tables, table); },
      [&] {
        if (hdf5::has(tables, table.name)) hdf5::remove(tables, table.name);
      });
}

void RunFile::note_resumption() {
  with_file_named(path_, [&] {
    const std::string before = hdf5::read_text(image_->file, "resumed");
    hdf5::rewrite_text(image_->file, "resumed", before + (before.empty() ? "" : ", ") + time_of_day());
  });
}

bool RunFile::begun() const { return image_->published; }

void RunFile::finish() {
  const Handle& file = image_->file;
  image_->change(
      path_, [&] { hdf5::rewrite_text(file, "finished", time_of_day()); }, [&] { hdf5::rewrite_text(file, "finished", ""); });
}

std::size_t RunFile::run_count() const { return image_->run_count; }

bool RunFile::has_table(const std::string& name) const { return hdf5::has(image_->tables, name); }

bool RunFile::finished() const {
  return with_file_named(path_, [&] { return !hdf5::read_text(image_->file, "finished").empty(); });
}

std::vector<std::byte> to_bytes(const RunRecord& run) {
  return with_file_named("a run", [&] {
    const Handle file = hdf5::create_in_memory();
    write_run(file, run_name(0), run);
    return hdf5::image(file);
  });
}

RunRecord run_of(std::span<const std::byte> bytes) {
  return with_file_named("a run", [&] { return read_run(hdf5::open_group(hdf5::open_image(bytes), run_name(0))); });
}

std::vector<RunRecord> read_runs(const fs::path& path) {
  return with_file_named(path, [&] { return runs_of(open_run_file(path)); });
}

std::vector<Table> read_tables(const fs::path& path) {
  return with_file_named(path, [&] { return tables_of(open_run_file(path)); });
}

Provenance read_provenance(const fs::path& path) {
  return with_file_named(path, [&] { return facts_of(open_run_file(path)); });
}

Recording read_recording(const fs::path& path) {
  return with_file_named(path, [&] {
    const Handle file = open_run_file(path);
    return Recording{facts_of(file), runs_of(file), tables_of(file)};
  });
}

}  // namespace drape::results
