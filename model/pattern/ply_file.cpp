#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/keys/scene_error.hpp"
#include "model/pattern/garment_mesh.hpp"
#include "model/pattern/readers.hpp"
#include "solver/base/printable.hpp"

namespace drape::model {
namespace {

/// A type of numbers, under both of its names.
struct PlyType {
  std::string_view name, other_name;
  std::size_t bytes;
  double (*read)(const char* bytes);
};

template <class Number>
double read_as_number(const char* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof number);
  return static_cast<double>(number);
}

template <class Number>
constexpr PlyType ply_type(std::string_view name, std::string_view other_name) {
  return {name, other_name, sizeof(Number), read_as_number<Number>};
}

constexpr PlyType ply_types[] = {ply_type<std::int8_t>("char", "int8"),    ply_type<std::uint8_t>("uchar", "uint8"),
                                 ply_type<std::int16_t>("short", "int16"), ply_type<std::uint16_t>("ushort", "uint16"),
                                 ply_type<std::int32_t>("int", "int32"),   ply_type<std::uint32_t>("uint", "uint32"),
                                 ply_type<float>("float", "float32"),      ply_type<double>("double", "float64")};

struct PlyProperty {
  std::string name;
  const PlyType* count;  ///< of a list; null: one number
  const PlyType* number;
};

struct PlyElement {
  std::string name;
  std::size_t count;
  std::vector<PlyProperty> properties;
};

/// Reads a PLY element by element. Assimp takes a truncated file for a whole one, and does not end on some that are damaged.
class PlyReader {
 public:
  PlyReader(const std::string& file, std::string text) : text_(std::move(text)) { mesh_.file = base::printable(file); }

  GarmentMesh read() {
    read_header();
    mesh_.has_lines = !binary_;
    for (const PlyElement& element : elements_) {
      element_ = element.name;
      for (std::size_t k = 0; k < element.count; ++k) {
        if (!binary_) next_line();
        if (binary_) place_ = static_cast<int>(k);
        read_one(element);
      }
    }
    if (mesh_.faces.empty()) throw SceneError(mesh_.file + ": expected a PLY with faces");
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    if (binary_ && !element_.empty())
      throw SceneError(fmt::format("{}: {} {}: {}", mesh_.file, base::printable(element_), place_, what));
    throw SceneError(fmt::format("{}:{}: {}", mesh_.file, place_, what));
  }

  void next_line() {
    place_ = ++line_;
    if (at_ >= text_.size()) fail("expected more lines, as the header says");
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    words_ = std::istringstream(text_.substr(at_, end - at_));
    at_ = std::min(end + 1, text_.size());
  }

  std::string word() {
    std::string word;
    words_ >> word;
    return word;
  }

  const PlyType* type(const std::string& name) const {
    const auto* const found =
        std::ranges::find_if(ply_types, [&](const PlyType& any) { return any.name == name || any.other_name == name; });
    if (found == std::end(ply_types)) fail(fmt::format("'{}': expected a type, as float", base::quoted(name)));
    return found;
  }

  void read_header() {
    next_line();
    if (word() != "ply") fail("expected a PLY, which begins with \"ply\"");
    for (;;) {
      next_line();
      const std::string key = word();
      if (key == "end_header") return;
      if (key == "format")
        read_format(word());
      else if (key == "element")
        read_element();
      else if (key == "property")
        read_property();
    }
  }

  void read_format(const std::string& format) {
    binary_ = format == "binary_little_endian";
    if (!binary_ && format != "ascii")
      fail(fmt::format("'{}': expected the format ascii or binary_little_endian", base::quoted(format)));
  }

  void read_element() {
    PlyElement& element = elements_.emplace_back();
    constexpr std::size_t most = 10'000'000;
    if (!(words_ >> element.name >> element.count) || element.count > most)
      fail(fmt::format("expected an element and its number, at most {}", most));
  }

  void read_property() {
    if (elements_.empty()) fail("expected an element before its properties");
    const std::string first = word();
    PlyProperty property{{}, nullptr, nullptr};
    if (first == "list") property.count = type(word());
    property.number = type(first == "list" ? word() : first);
    property.name = word();
    elements_.back().properties.push_back(property);
  }

  double number(const PlyType& type) {
    double value = NAN;
    if (!binary_) {
      if (!(words_ >> value)) fail("expected a number for each property");
      return value;
    }
    if (type.bytes > text_.size() - at_) fail("expected more bytes, as the header says");
    value = type.read(text_.data() + at_);
    at_ += type.bytes;
    return value;
  }

  void read_one(const PlyElement& element) {
    std::map<std::string, double> values;
    for (const PlyProperty& property : element.properties) {
      if (property.count == nullptr) {
        values[property.name] = number(*property.number);
        continue;
      }
      const bool is_polygon = element.name == "face" && property.name.starts_with("vertex_ind");
      std::vector<MeshCorner> corners;
      for (double left = number(*property.count); left >= 1; --left) {
        const double index = number(*property.number);
        if (is_polygon) corners.push_back(corner(index));
      }
      if (is_polygon) add_polygon(mesh_, corners, place_);
    }
    if (element.name == "vertex") add_vertex(values);
  }

  void add_vertex(const std::map<std::string, double>& values) {
    constexpr double largest = 1e6;
    const auto value = [&](const char* name) {
      const auto found = values.find(name);
      if (found == values.end() || !(std::abs(found->second) <= largest))
        fail(fmt::format("expected {} of a vertex, a number of at most a million", name));
      return found->second;
    };
    mesh_.vertices.emplace_back(value("x"), value("y"), value("z"));
    for (const auto& [u, v] : {std::pair("s", "t"), {"u", "v"}, {"texture_u", "texture_v"}})
      if (values.contains(u)) return void(mesh_.places.emplace_back(value(u), value(v)));
  }

  MeshCorner corner(double index) const {
    const auto count = static_cast<double>(mesh_.vertices.size());
    if (!(index >= 0 && index < count && index == std::floor(index)))
      fail(fmt::format("{:g}: expected one of the vertices 0 to {:g}, which come first", index, count - 1));
    return {static_cast<int>(index), static_cast<int>(index)};
  }

  std::string text_;
  std::size_t at_ = 0;
  std::istringstream words_;
  int line_ = 0;
  std::string element_;  ///< what is read; empty: the header
  int place_ = 0;        ///< for messages: the line, in binary the number of the element
  bool binary_ = false;
  std::vector<PlyElement> elements_;
  GarmentMesh mesh_;
};

}  // namespace

GarmentMesh read_ply(const std::string& file) {
  GarmentMesh mesh = PlyReader(file, pattern_text(file)).read();
  weld(mesh);
  return mesh;
}

}  // namespace drape::model
