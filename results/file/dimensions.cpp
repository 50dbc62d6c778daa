#include "results/file/dimensions.hpp"

#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "results/file/schema.hpp"

namespace drape::results {
namespace {

using hdf5::Handle;

/// Datasets that name a dimension: of steps and frames, of particles, of the columns of vectors, of rows, of scene keys.
constexpr const char *time_scale = "t", *particle_scale = "particle", *axis_scale = "axis", *row_scale = "row",
                     *key_scale = "key";

void write_counting(const Handle& group, const char* name, std::uint64_t count, const char* description) {
  std::vector<std::int64_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0);
  hdf5::write_numbers(group, name, numbers.data(), {count}, "1", description);
}

/// Names the first dimensions of a dataset; nothing if the group has none of this name, or it is a scale itself.
void name(const Handle& group, const std::string& dataset, const std::vector<const char*>& scales) {
  if (!hdf5::has(group, dataset) || dataset == scales.front()) return;
  for (std::size_t k = 0; k < scales.size(); ++k) hdf5::name_dimension(group, dataset, static_cast<unsigned>(k), scales[k]);
}

void name_state(const Handle& group, std::vector<const char*> scales) {
  for_each(state_fields, [&](const auto& field) { name(group, field.name, scales); });
}

void name_trajectory(const Handle& group) {
  for (const char* of_particles : {"stretch", "constraint"}) name(group, of_particles, {time_scale, particle_scale});
  name_state(group, {time_scale, particle_scale, axis_scale});
}

}  // namespace

void write_particle_scales(const Handle& group, std::uint64_t particles) {
  write_counting(group, particle_scale, particles, "number of the particle");
  hdf5::write_texts(group, axis_scale, {"x", "y", "z"}, "direction of the component");
}

void write_row_scale(const Handle& table, std::uint64_t rows) {
  if (!hdf5::has(table, row_scale)) write_counting(table, row_scale, rows, "number of the row");
}

void name_dimensions_of_run(const Handle& run) {
  const Handle steps = hdf5::open_group(run, "steps"), keys = hdf5::open_group(run, "scene_keys");
  for_each(step_fields, [&](const auto& field) { name(steps, field.name, {time_scale}); });
  for_each(scene_key_fields, [&](const auto& field) { name(keys, field.name, {key_scale}); });
  name_state(hdf5::open_group(run, "final_state"), {particle_scale, axis_scale});
  if (hdf5::has(run, "trajectory")) name_trajectory(hdf5::open_group(run, "trajectory"));
}

void name_dimensions_of_table(const Handle& table) {
  for (const std::string& column : hdf5::read_texts(table, "columns"))
    for (const std::string_view part : {"", ".standing"}) name(table, column + std::string(part), {row_scale});
}

void name_dimensions(const Handle& file) {
  const Handle runs = hdf5::open_group(file, "runs"), tables = hdf5::open_group(file, "tables");
  for (const std::string& run : hdf5::groups(runs)) name_dimensions_of_run(hdf5::open_group(runs, run));
  for (const std::string& table : hdf5::groups(tables)) name_dimensions_of_table(hdf5::open_group(tables, table));
}

}  // namespace drape::results
