#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/obstacles/mesh_shape.hpp"
#include "model/obstacles/shapes/shape_kinds.hpp"
#include "solver/base/hash.hpp"
#include "solver/base/input_file.hpp"

namespace drape::model {
namespace {

struct Mesh : ShapeRule {
  std::string file;
  double scale = 1;
  std::vector<FrameFile> frames;  ///< empty: it is not given by frames
  std::string animation;          ///< empty: none
  double rate = 60;               ///< at which the animation is sampled [1/s]

  std::unique_ptr<const Shape> make() const override { return mesh_shape(read(), scale); }

  Polygons surface(double /*plane_side*/) const override {
    const KeyedMesh keyed = read();
    Polygons polygons;
    for (const Eigen::Vector3d& vertex : keyed.keys.empty() ? keyed.mesh.vertices : keyed.keys.front().vertices)
      polygons.vertices.emplace_back(scale * vertex);
    for (const auto& [a, b, c] : keyed.mesh.triangles) polygons.faces.push_back({a, b, c});
    return polygons;
  }

  bool moves() const override { return frames.size() > 1 || !animation.empty(); }

 private:
  KeyedMesh read() const {
    if (!frames.empty()) return read_frames(file, frames);
    if (!animation.empty()) return read_animation(file, animation, rate);
    return {read_mesh(file), {}};
  }
};

/// XXH3 of the bytes of a file.
std::string checksum(const std::string& file) {
  try {
    return base::hash_text(base::content_of(file, most_mesh_bytes));
  } catch (const base::UnreadableFile& error) {
    throw std::invalid_argument(fmt::format("{}: {}: expected the mesh of an obstacle", file, error.what()));
  }
}

template <auto file, class Record>
void read_mesh_file(const Value& value, Record& record) {
  at<file>.in(record) = value.input_file("the file of a mesh", most_mesh_bytes);
}

template <auto file, class Record>
Data mesh_file_data(const Record& record) {
  return at<file>.in(record);
}

template <auto file, class Record>
void read_checksum(const Value& value, Record& record) {
  const std::string& name = at<file>.in(record);
  if (value.text() != checksum(name)) value.fail(fmt::format("{}, that of {}", checksum(name), name));
}

template <auto file, class Record>
Data checksum_data(const Record& record) {
  return checksum(at<file>.in(record));
}

constexpr Key<FrameFile> frame_file_keys[] = {
    {"time", "s", "when", at<&FrameFile::t>, check::number, true},
    {"file", "", "the mesh with its vertices there", read_mesh_file<&FrameFile::file>, mesh_file_data<&FrameFile::file>, true},
    {"checksum", "", "of the file", read_checksum<&FrameFile::file>, checksum_data<&FrameFile::file>},
};

void read_frame_files(const Value& value, ShapeRule& rule) {
  std::vector<FrameFile>& frames = at<&Mesh::frames>.in(rule);
  for (const Value& frame : value.list())
    read_table<FrameFile>(frame, "frame of a mesh", frame_file_keys, frames.emplace_back());
  if (frames.empty()) value.fail("at least one frame");
  if (std::ranges::adjacent_find(frames, std::ranges::greater_equal{}, &FrameFile::t) != frames.end())
    value.fail("frames with times that ascend");
}

Data frame_files_data(const ShapeRule& rule) {
  List frames;
  for (const FrameFile& frame : at<&Mesh::frames>.in(rule)) frames.emplace_back(entries_of<FrameFile>(frame_file_keys, frame));
  return frames.empty() ? Data() : Data(frames);
}

void read_animation_name(const Value& value, ShapeRule& rule) {
  at<&Mesh::animation>.in(rule) = value.text();
  if (value.text().empty()) value.fail("the name of an animation, or its index in quotes");
  if (!at<&Mesh::frames>.in(rule).empty()) value.fail("'frames' or 'animation', not both");
}

Data animation_name_data(const ShapeRule& rule) {
  const std::string& animation = at<&Mesh::animation>.in(rule);
  return animation.empty() ? Data() : animation;
}

void read_rate(const Value& value, ShapeRule& rule) {
  at<&Mesh::rate>.in(rule) = value.positive();
  if (at<&Mesh::animation>.in(rule).empty()) value.fail("'animation' beside it");
}

Data rate_data(const ShapeRule& rule) { return at<&Mesh::animation>.in(rule).empty() ? Data() : at<&Mesh::rate>.in(rule); }

// A checksum is read behind its file, what depends on another key behind that.
constexpr Key<ShapeRule> mesh_keys[] = {
    {"file", "", "a closed mesh of triangles", read_mesh_file<&Mesh::file>, mesh_file_data<&Mesh::file>, true},
    {"checksum", "", "of the file", read_checksum<&Mesh::file>, checksum_data<&Mesh::file>},
    {"scale", "1", "metres for a unit of the file", at<&Mesh::scale>, check::positive},
    {"frames", "", "files with its vertices at key times: list of { time, file }", read_frame_files, frame_files_data},
    {"animation", "", "of the file, which moves it from t = 0 on: its name, or its index", read_animation_name,
     animation_name_data},
    {"rate", "1/s", "at which the animation is sampled", read_rate, rate_data},
};

}  // namespace

const ShapeKind shapes::mesh{.name = "mesh",
                             .description = "what the triangles of a file enclose",
                             .smooth = true,
                             .create = create<Mesh>,
                             .keys = keys_in<mesh_keys>};

}  // namespace drape::model
