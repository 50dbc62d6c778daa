#include "results/file/motion_file.hpp"

#include "results/file/hdf5.hpp"

namespace drape::results {
namespace {

using hdf5::Handle;

void write_vectors(const Handle& file, const char* name, const std::vector<solver::Vectors>& frames, const char* unit,
                   const char* description) {
  std::vector<double> all;
  for (const solver::Vectors& frame : frames) all.insert(all.end(), frame.data(), frame.data() + frame.size());
  hdf5::write_frames(file, name, all.data(), {frames.size(), static_cast<std::uint64_t>(frames.front().rows()), 3}, unit,
                     description);
}

std::vector<solver::Vectors> read_vectors(const Handle& file, const char* name, std::size_t count) {
  const std::vector<double> all = hdf5::read_numbers<double>(file, name);
  const std::size_t frame = count == 0 ? 0 : all.size() / count;
  std::vector<solver::Vectors> frames;
  for (std::size_t k = 0; k < count; ++k)
    frames.emplace_back(Eigen::Map<const solver::Vectors>(all.data() + k * frame, static_cast<Eigen::Index>(frame / 3), 3));
  return frames;
}

}  // namespace

std::vector<std::byte> to_bytes(const ReferenceMotion& reference) {
  const Motion& motion = reference.motion;
  const Handle file = hdf5::create_in_memory();
  hdf5::write_described_text(file, "scene", reference.scene, "name of the scene");
  hdf5::write_described_text(file, "families", reference.families, "the two families of solvers that agree on this motion");
  hdf5::write_numbers(file, "time", motion.times.data(), {motion.times.size()}, "s", "time of each frame");
  write_vectors(file, "positions", motion.positions, "m", "positions of the particles, frame by frame");
  if (!motion.velocities.empty()) write_vectors(file, "velocities", motion.velocities, "m/s", "velocities of the particles");
  hdf5::write_numbers(file, "uncertainty", reference.uncertainty.data(), {reference.uncertainty.size()}, "m",
                      "of the positions of each frame: root mean square over the particles");
  return hdf5::image(file);
}

Motion read_motion(const std::filesystem::path& path) {
  const Handle file = hdf5::open_unsealed(path);
  Motion motion{hdf5::read_numbers<double>(file, "time"), {}, {}};
  motion.positions = read_vectors(file, "positions", motion.times.size());
  if (hdf5::has(file, "velocities")) motion.velocities = read_vectors(file, "velocities", motion.times.size());
  return motion;
}

}  // namespace drape::results
