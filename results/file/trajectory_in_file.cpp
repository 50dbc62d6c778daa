#include "results/file/trajectory_in_file.hpp"

#include <fmt/format.h>

#include <span>
#include <type_traits>
#include <utility>

#include "results/file/dimensions.hpp"
#include "results/file/schema.hpp"

namespace drape::results {
namespace {

using hdf5::Handle;

std::uint64_t particles(const TrajectoryRecord& trajectory) {
  return static_cast<std::uint64_t>(trajectory.nu) * static_cast<std::uint64_t>(trajectory.nv);
}

// --- Members by their type -----------------------------------------------------------------------------------------------

void write_member(const Handle& group, const auto& field, const TrajectoryRecord&, int value) {
  hdf5::write_numbers(group, field.name, &value, {}, field.unit, field.description);
}

void write_member(const Handle& group, const auto& field, const TrajectoryRecord&, const std::vector<double>& values) {
  hdf5::write_numbers(group, field.name, values.data(), {values.size()}, field.unit, field.description);
}

/// The values of all frames, one frame after the other: a list of numbers each, or three columns.
template <class Values>
void write_member(const Handle& group, const auto& field, const TrajectoryRecord& trajectory,
                  const std::vector<Values>& frames) {
  using Number = std::remove_cvref_t<decltype(*frames.front().data())>;
  std::vector<Number> all;
  for (const Values& frame : frames) all.insert(all.end(), frame.data(), frame.data() + frame.size());
  std::vector<std::uint64_t> shape{frames.size(), particles(trajectory)};
  if constexpr (std::is_same_v<Values, solver::Vectors>) shape.push_back(3);
  hdf5::write_frames(group, field.name, all.data(), shape, field.unit, field.description);
}

void read_member(const Handle& group, const char* name, const TrajectoryRecord&, int& value) {
  value = hdf5::read_number<int>(group, name);
  if (value < 1) throw hdf5::Error(fmt::format("trajectory/{} must be at least 1", name));
}

void read_member(const Handle& group, const char* name, const TrajectoryRecord&, std::vector<double>& values) {
  values = hdf5::read_numbers<double>(group, name);
}

/// Takes over the numbers of one frame.
void assign(std::span<const double> numbers, solver::Vectors& values) {
  values = Eigen::Map<const solver::Vectors>(numbers.data(), static_cast<Eigen::Index>(numbers.size() / 3), 3);
}
void assign(std::span<const double> numbers, Eigen::VectorXd& values) {
  values = Eigen::Map<const Eigen::VectorXd>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}
void assign(std::span<const int> numbers, std::vector<int>& values) { values.assign(numbers.begin(), numbers.end()); }

/// All frames, in the order and number of the times, which are read already.
template <class Values>
void read_member(const Handle& group, const char* name, const TrajectoryRecord& trajectory, std::vector<Values>& frames) {
  using Number = std::remove_cvref_t<decltype(*frames.front().data())>;
  const std::vector<Number> all = hdf5::read_numbers<Number>(group, name);
  const std::size_t count = trajectory.times.size();
  const std::size_t a_frame = particles(trajectory) * (std::is_same_v<Values, solver::Vectors> ? 3 : 1);
  if (count == 0 ? !all.empty() : all.size() / count != a_frame || all.size() % count != 0)
    throw hdf5::Error(fmt::format("trajectory/{}: expected {} numbers in each of {} frames", name, a_frame, count));
  frames.resize(count);
  for (std::size_t k = 0; k < count; ++k) assign(std::span(all).subspan(k * a_frame, a_frame), frames[k]);
}

/// Only of several panels.
constexpr const char* panels_name = "panels";

std::vector<std::array<int, 2>> read_panels(const Handle& group, int particles) {
  std::vector<std::array<int, 2>> panels;
  if (!hdf5::has(group, panels_name)) return panels;
  const std::vector<int> numbers = hdf5::read_numbers<int>(group, panels_name);
  std::int64_t sum = 0;
  for (std::size_t k = 0; k + 1 < numbers.size(); k += 2) {
    panels.push_back({numbers[k], numbers[k + 1]});
    if (numbers[k] < 1 || numbers[k + 1] < 1) throw hdf5::Error("trajectory/panels must be at least 1");
    sum += static_cast<std::int64_t>(numbers[k]) * numbers[k + 1];
  }
  if (sum != particles || numbers.size() % 2 != 0)
    throw hdf5::Error(fmt::format("trajectory/panels: expected nu and nv of panels with {} particles together", particles));
  return panels;
}

}  // namespace

void write_trajectory(const Handle& run, const TrajectoryRecord& trajectory) {
  const Handle group = hdf5::create_group(run, "trajectory", "the motion, frame by frame");
  for_each(trajectory_fields, [&](const auto& field) { write_member(group, field, trajectory, trajectory.*field.member); });
  if (!trajectory.panels.empty())
    hdf5::write_numbers(group, panels_name, trajectory.panels.front().data(), {trajectory.panels.size(), 2}, "1",
                        "nu and nv of each panel, whose particles follow one another");
  for_each(state_fields, [&](const auto& field) {
    std::vector<solver::Vectors> frames;
    for (const solver::State& state : trajectory.states) frames.push_back(state.*field.member);
    write_member(group, field, trajectory, frames);
  });
  write_particle_scales(group, particles(trajectory));
}

TrajectoryRecord read_trajectory(const Handle& run) {
  const Handle group = hdf5::open_group(run, "trajectory");
  TrajectoryRecord trajectory;
  for_each(trajectory_fields, [&](const auto& field) { read_member(group, field.name, trajectory, trajectory.*field.member); });
  trajectory.panels = read_panels(group, trajectory.nu * trajectory.nv);
  trajectory.states.resize(trajectory.times.size());
  for_each(state_fields, [&](const auto& field) {
    std::vector<solver::Vectors> frames;
    read_member(group, field.name, trajectory, frames);
    for (std::size_t k = 0; k < frames.size(); ++k) trajectory.states[k].*field.member = std::move(frames[k]);
  });
  return trajectory;
}

}  // namespace drape::results
