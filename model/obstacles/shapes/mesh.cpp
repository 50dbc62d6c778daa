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
  AnimationRule animation;

  std::unique_ptr<const Shape> make() const override { return mesh_shape(read(), scale); }

  Polygons surface(double /*plane_side*/) const override {
    const KeyedMesh keyed = read();
    Polygons polygons;
    for (const Eigen::Vector3d& vertex : keyed.keys.empty() ? keyed.mesh.vertices : keyed.keys.front().vertices)
      polygons.vertices.emplace_back(scale * vertex);
    for (const auto& [a, b, c] : keyed.mesh.triangles) polygons.faces.push_back({a, b, c});
    return polygons;
  }

  bool moves() const override { return frames.size() > 1 || !animation.name.empty(); }

 private:
  KeyedMesh read() const {
    if (!frames.empty()) return read_frames(file, frames);
    if (!animation.name.empty()) return read_animation(file, animation);
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

AnimationRule& animation_of(ShapeRule& rule) { return at<&Mesh::animation>.in(rule); }
const AnimationRule& animation_of(const ShapeRule& rule) { return at<&Mesh::animation>.in(rule); }

void read_animation_name(const Value& value, ShapeRule& rule) {
  animation_of(rule).name = value.text();
  if (value.text().empty()) value.fail("the name of an animation, or its index in quotes");
  if (!at<&Mesh::frames>.in(rule).empty()) value.fail("'frames' or 'animation', not both");
}

Data animation_name_data(const ShapeRule& rule) {
  const AnimationRule& animation = animation_of(rule);
  return animation.name.empty() ? Data() : animation.name;
}

/// A number that says how the animation is played.
template <double AnimationRule::*member, double (Value::*read)() const>
void read_of_animation(const Value& value, ShapeRule& rule) {
  animation_of(rule).*member = (value.*read)();
  if (animation_of(rule).name.empty()) value.fail("'animation' beside it");
}

template <double AnimationRule::*member>
Data of_animation_data(const ShapeRule& rule) {
  const AnimationRule& animation = animation_of(rule);
  return animation.name.empty() ? Data() : animation.*member;
}

// A checksum is read behind its file, what depends on another key behind that.
constexpr Key<ShapeRule> mesh_keys[] = {
    {"file", "", "a closed mesh of triangles", read_mesh_file<&Mesh::file>, mesh_file_data<&Mesh::file>, true},
    {"checksum", "", "of the file", read_checksum<&Mesh::file>, checksum_data<&Mesh::file>},
    {"scale", "1", "metres for a unit of the file", at<&Mesh::scale>, check::positive},
    {"frames", "", "files with its vertices at key times: list of { time, file }", read_frame_files, frame_files_data},
    {"animation", "", "of the file, which moves it from t = 0 on: its name, or its index", read_animation_name,
     animation_name_data},
    {"rate", "1/s", "at which the animation is sampled", read_of_animation<&AnimationRule::rate, &Value::positive>,
     of_animation_data<&AnimationRule::rate>},
    {"start", "s", "time of the animation at t = 0", read_of_animation<&AnimationRule::start, &Value::non_negative>,
     of_animation_data<&AnimationRule::start>},
};

}  // namespace

const ShapeKind shapes::mesh{.name = "mesh",
                             .description = "what the triangles of a file enclose",
                             .smooth = true,
                             .create = create<Mesh>,
                             .keys = keys_in<mesh_keys>};

}  // namespace drape::model
