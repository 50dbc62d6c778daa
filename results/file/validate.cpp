#include "results/file/validate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <type_traits>

#include "results/file/hdf5.hpp"
#include "results/file/schema.hpp"
#include "results/file/table_in_file.hpp"
#include "solver/base/atomic_file.hpp"

namespace drape::results {
namespace {

using hdf5::Handle;
using hdf5::Item;
using Shape = std::vector<std::uint64_t>;

/// Versions of libraries may stand beside them.
constexpr const char* known_facts[] = {"version",      "git_commit",   "compiler", "build_type", "compile_flags", "native",
                                       "sanitizers",   "program_hash", "cpu",      "cores",      "host_os",       "started",
                                       "command_line", "sweep",        "resumed",  "finished"};

/// A file that is checked piece by piece against what must be there; what is left in the end is too much.
class Check {
 public:
  explicit Check(const Handle& file) : left_(hdf5::inventory(file)) {}

  void note(const std::string& path, const std::string& what) { deviations_.push_back(fmt::format("{}: {}", path, what)); }

  /// Takes an object out; null if it is missing or of another type.
  std::optional<Item> take(const std::string& path, std::string_view type) {
    const auto node = left_.extract(path);
    if (node.empty()) return note(path, "is missing"), std::nullopt;
    if (node.mapped().type == type) return node.mapped();
    return note(path, fmt::format("is {} instead of {}", node.mapped().type, type)), std::nullopt;
  }

  void attribute(const std::string& object, const std::string& name, std::string_view type) {
    const auto item = take(fmt::format("{}@{}", object, name), type);
    if (item && !item->shape.empty()) note(fmt::format("{}@{}", object, name), "must be a single value");
  }

  void described_text(const std::string& object, const std::string& name) {
    attribute(object, name, "text");
    attribute(object, name + ".description", "text");
  }

  bool group(const std::string& path) { return take(path, "group") && (attribute(path, "description", "text"), true); }

  /// A dataset of this number of dimensions; its shape if it is as it must be.
  std::optional<Shape> numbers(const std::string& path, std::string_view type, std::size_t dimensions,
                               const std::optional<std::string>& unit) {
    const auto item = take(path, type);
    for (const char* text : {"unit", "description"})
      if (item) attribute(path, text, "text");
    if (!item) return std::nullopt;
    if (unit && item->unit != *unit) note(path, fmt::format("its unit is '{}' instead of '{}'", item->unit, *unit));
    if (item->shape.size() == dimensions) return item->shape;
    return note(path, fmt::format("has {} dimensions instead of {}", item->shape.size(), dimensions)), std::nullopt;
  }

  /// Names of what is left directly in a group.
  std::vector<std::string> members(const std::string& path) const {
    std::vector<std::string> names;
    for (auto item = left_.lower_bound(path + "/"); item != left_.end() && item->first.starts_with(path + "/"); ++item)
      if (const std::string name = item->first.substr(path.size() + 1); name.find_first_of("/@") == std::string::npos)
        names.push_back(name);
    return names;
  }

  const Item* find(const std::string& path) const {
    const auto item = left_.find(path);
    return item == left_.end() ? nullptr : &item->second;
  }

  std::vector<std::string> finish() {
    for (const auto& [path, item] : left_) note(path, "is not in the specification");
    return std::move(deviations_);
  }

 private:
  std::map<std::string, Item> left_;
  std::vector<std::string> deviations_;
};

template <class Value>
constexpr std::string_view type_of = std::is_same_v<Value, int> ? "int32" : "float64";

// --- Members of records by their type; those of numbers give their shapes ------------------------------------------------

std::optional<Shape> member(Check& check, const std::string& group, const auto& field, const std::string*) {
  return check.described_text(group, field.name), std::nullopt;
}

std::optional<Shape> member(Check& check, const std::string& group, const auto& field, const solver::Outcome*) {
  return check.described_text(group, field.name), std::nullopt;
}

std::optional<Shape> member(Check& check, const std::string& group, const auto& field, const double*) {
  return check.numbers(fmt::format("{}/{}", group, field.name), "float64", 0, field.unit);
}

std::optional<Shape> member(Check& check, const std::string& group, const auto& field, const std::vector<double>*) {
  return check.numbers(fmt::format("{}/{}", group, field.name), "float64", 1, field.unit);
}

std::optional<Shape> member(Check& check, const std::string& group, const auto& field, const solver::Vectors*) {
  const std::string path = fmt::format("{}/{}", group, field.name);
  auto shape = check.numbers(path, "float64", 2, field.unit);
  if (shape && shape->back() != 3) check.note(path, fmt::format("has {} columns instead of 3", shape->back()));
  return shape;
}

template <class Record>
void fields(Check& check, const std::string& group, const auto& list) {
  if (check.group(group))
    for_each(list, [&]<class Value>(const Field<Record, Value>& field) {
      member(check, group, field, static_cast<const Value*>(nullptr));
    });
}

/// What must have the same number of rows.
class SameRows {
 public:
  SameRows(Check& check, std::string what) : check_(check), what_(std::move(what)) {}

  void see(const std::string& path, const std::optional<Shape>& shape) {
    if (!shape) return;
    if (!rows_) rows_ = shape->front();
    if (*rows_ != shape->front()) check_.note(path, fmt::format("has {} {} instead of {}", shape->front(), what_, *rows_));
  }

 private:
  Check& check_;
  std::string what_;
  std::optional<std::uint64_t> rows_;
};

// --- Groups --------------------------------------------------------------------------------------------------------------

void check_steps(Check& check, const std::string& group) {
  if (!check.group(group)) return;
  SameRows steps(check, "steps");
  for_each(step_fields, [&]<class Value>(const Field<StepRecord, Value>& field) {
    const std::string path = fmt::format("{}/{}", group, field.name);
    steps.see(path, check.numbers(path, type_of<Value>, 1, field.unit));
  });
}

/// As many keys as values and units.
void check_scene_keys(Check& check, const std::string& group) {
  if (!check.group(group)) return;
  SameRows keys(check, "keys");
  for_each(scene_key_fields, [&](const auto& field) {
    const std::string path = fmt::format("{}/{}", group, field.name);
    keys.see(path, check.numbers(path, "text", 1, field.unit));
  });
}

/// Files of older programs have none.
void check_particle_scales(Check& check, const std::string& group, SameRows& particles) {
  const std::string particle = group + "/particle", axis = group + "/axis";
  if (check.find(particle) != nullptr) particles.see(particle, check.numbers(particle, "int64", 1, "1"));
  if (check.find(axis) != nullptr) check.numbers(axis, "text", 1, "");
}

void check_state(Check& check, const std::string& group) {
  if (!check.group(group)) return;
  SameRows particles(check, "particles");
  for_each(state_fields, [&]<class Value>(const Field<solver::State, Value>& field) {
    particles.see(fmt::format("{}/{}", group, field.name), member(check, group, field, static_cast<const Value*>(nullptr)));
  });
  check_particle_scales(check, group, particles);
  const std::string memory = fmt::format("{}/{}", group, memory_field.name);
  if (check.find(memory) != nullptr) check.numbers(memory, "float64", 1, memory_field.unit);
}

/// A '/' in the name of a count makes groups.
void check_work(Check& check, const std::string& group) {
  for (const std::string& name : check.members(group)) {
    const std::string path = fmt::format("{}/{}", group, name);
    if (check.find(path)->type == "group") {
      check.take(path, "group");
      check_work(check, path);
    } else {
      check.numbers(path, "int64", 0, "1");
    }
  }
}

/// Frames of particles: as many as there are times.
void check_trajectory(Check& check, const std::string& group) {
  if (!check.group(group)) return;
  SameRows frames(check, "frames");
  const auto path = [&](const auto& field) { return fmt::format("{}/{}", group, field.name); };
  for_each(trajectory_fields, [&]<class Value>(const Field<TrajectoryRecord, Value>& field) {
    if constexpr (std::is_same_v<Value, int>)
      check.numbers(path(field), "int32", 0, field.unit);
    else if constexpr (std::is_same_v<Value, std::vector<double>>)
      frames.see(path(field), check.numbers(path(field), "float64", 1, field.unit));
    else if constexpr (std::is_same_v<Value, std::vector<std::vector<int>>>)
      frames.see(path(field), check.numbers(path(field), "int32", 2, field.unit));
    else
      frames.see(path(field), check.numbers(path(field), "float64", 2, field.unit));
  });
  for_each(state_fields,
           [&](const auto& field) { frames.see(path(field), check.numbers(path(field), "float64", 3, field.unit)); });
  SameRows particles(check, "particles");
  check_particle_scales(check, group, particles);
  if (const std::string panels = group + "/panels"; check.find(panels) != nullptr) check.numbers(panels, "int32", 2, "1");
}

void check_run(Check& check, const std::string& group) {
  fields<RunRecord>(check, group, run_fields);
  if (check.find(group + "/scene_keys") != nullptr) check_scene_keys(check, group + "/scene_keys");
  check_steps(check, group + "/steps");
  if (check.group(group + "/parameters"))
    for (const std::string& name : check.members(group + "/parameters"))
      check.numbers(fmt::format("{}/parameters/{}", group, name), "float64", 0, std::nullopt);
  if (check.group(group + "/work")) check_work(check, group + "/work");
  check_state(check, group + "/final_state");
  if (check.find(group + "/choice") != nullptr) fields<ChoiceRecord>(check, group + "/choice", choice_fields);
  if (check.find(group + "/error") != nullptr) fields<ErrorRecord>(check, group + "/error", error_fields);
  if (check.find(group + "/motion_error") != nullptr)
    fields<MotionErrorRecord>(check, group + "/motion_error", motion_error_fields);
  if (check.find(group + "/contact") != nullptr) fields<ContactRecord>(check, group + "/contact", contact_fields);
  if (check.find(group + "/trajectory") != nullptr) check_trajectory(check, group + "/trajectory");
}

void check_column(Check& check, const std::string& path, SameRows& rows) {
  const Item* column = check.find(path);
  if (column == nullptr) return check.note(path, "is missing");
  const std::string type = column->type;
  const bool text = column->unit.empty();
  if (text ? type != "text" : type != "float64" && type != "int64") check.note(path, fmt::format("is {}", type));
  rows.see(path, check.numbers(path, type, 1, std::nullopt));
  const std::string standings = path + ".standing";
  if (check.find(standings) != nullptr) rows.see(standings, check.numbers(standings, "text", 1, std::nullopt));
}

/// The names of a table's columns, if they are as they must be; in versions 4 and 5 they are one text.
std::vector<std::string> checked_column_names(Check& check, const Handle& file, const std::string& group, int version) {
  const std::string path = group + (version > 5 ? "/columns" : "@columns");
  const bool readable = check.find(path) != nullptr && check.find(path)->type == "text";
  if (version > 5)
    check.numbers(path, "text", 1, "");
  else
    check.described_text(group, "columns");
  return readable ? column_names(hdf5::open_group(file, group), version) : std::vector<std::string>();
}

void check_table(Check& check, const Handle& file, const std::string& group, int version) {
  if (!check.group(group)) return;
  if (version > 4) {
    check.attribute(group, "headline", "int32");
    check.attribute(group, "figure", "text");
  }
  if (version > 5)
    for (const char* flag : {"timed_rows", "for_file"}) check.attribute(group, flag, "int32");
  SameRows rows(check, "rows");
  for (const std::string& name : checked_column_names(check, file, group, version)) {
    const std::string path = fmt::format("{}/{}", group, name);
    check_column(check, path, rows);
    check.attribute(group, name + ".title", "text");
    if (version > 4) check.attribute(group, name + ".role", "text");
    if (version > 5)
      for (const char* text : {".group", ".part"}) check.attribute(group, name + text, "text");
    if (check.find(path + ".classes") != nullptr) check.numbers(path + ".classes", "text", 1, "");
  }
  if (const std::string row = group + "/row"; check.find(row) != nullptr) rows.see(row, check.numbers(row, "int64", 1, "1"));
}

/// Texts with a description beyond the facts that we ask for: versions of libraries.
void check_facts(Check& check, const Handle& file) {
  std::set<std::string> names(std::begin(known_facts), std::end(known_facts));
  for (const std::string& name : hdf5::described_texts(file)) names.insert(name);
  for (const std::string& name : names) check.described_text("", name);
  check.attribute("", "description", "text");
  check.attribute("", "schema_version", "int32");
}

}  // namespace

std::vector<std::string> validate(const std::filesystem::path& path) {
  try {
    const auto [file, added, altered] = hdf5::open_with_changes(path);
    Check check(file);
    for (const std::string& where : altered) check.note(where, "has been altered by another program");
    for (const std::string& where : added) check.note(where, "has been added by another program");
    if (const Item* version = check.find("@schema_version"); version != nullptr && version->type == "int32")
      if (const int found = hdf5::read_integer(file, "schema_version");
          found < oldest_readable_version || found > schema_version)
        return {
            fmt::format("@schema_version: is {}, this program knows {} to {}", found, oldest_readable_version, schema_version)};
    check_facts(check, file);
    if (check.group("/runs"))
      for (int k = 0; check.find(fmt::format("/runs/{:03}", k)) != nullptr; ++k)
        check_run(check, fmt::format("/runs/{:03}", k));
    if (check.group("/tables"))
      for (const std::string& name : check.members("/tables"))
        check_table(check, file, "/tables/" + name, hdf5::read_integer(file, "schema_version"));
    return check.finish();
  } catch (const hdf5::Error& error) {
    throw base::FileError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

}  // namespace drape::results
