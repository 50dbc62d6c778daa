#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <map>
#include <sstream>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "model/keys/scene_error.hpp"
#include "model/pattern/garment_mesh.hpp"
#include "model/pattern/readers.hpp"
#include "solver/base/printable.hpp"

namespace drape::model {
namespace {

/// Reads an OBJ line by line.
class ObjReader {
 public:
  explicit ObjReader(const std::string& file) { mesh_.file = base::printable(file); }

  GarmentMesh read(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      ++line_;
      std::istringstream words(line);
      std::string key;
      words >> key;
      if (key == "v")
        mesh_.vertices.push_back(numbers<3>(words));
      else if (key == "vt")
        coordinates_.push_back(numbers<2>(words));
      else if (key == "f")
        read_polygon(words);
    }
    if (mesh_.faces.empty()) throw SceneError(mesh_.file + ": expected an OBJ with faces");
    return std::move(mesh_);
  }

 private:
  template <int size>
  Eigen::Vector<double, size> numbers(std::istringstream& words) {
    constexpr double largest = 1e6;
    Eigen::Vector<double, size> all;
    for (int c = 0; c < size; ++c)
      if (!(words >> all[c]) || !(std::abs(all[c]) <= largest))
        mesh_.fail(line_, fmt::format("expected {} numbers, of at most a million", size));
    return all;
  }

  /// A number of a list that counts from 1, or backwards from −1.
  int index(std::string_view text, std::size_t size, const char* list) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const int place = number < 0 ? static_cast<int>(size) + number : number - 1;
    if (error != std::errc() || end != text.data() + text.size() || place < 0 || place >= static_cast<int>(size))
      mesh_.fail(line_, fmt::format("'{}': expected one of the {} {} before it", base::quoted(text), size, list));
    return place;
  }

  /// The place on the pattern that a vertex has: exporters write the same coordinates again and again.
  int place_of(int vertex, const Eigen::Vector2d& p) {
    const auto [found, is_new] = places_.try_emplace({vertex, p.x(), p.y()}, static_cast<int>(mesh_.places.size()));
    if (is_new) mesh_.places.push_back(p);
    return found->second;
  }

  void read_polygon(std::istringstream& words) {
    std::vector<MeshCorner> corners;
    for (std::string word; words >> word;) {
      const std::string_view text = word;
      const auto slash = text.find('/');
      const std::string_view vertex = text.substr(0, slash), rest = slash == text.npos ? "" : text.substr(slash + 1);
      const std::string_view coordinates = rest.substr(0, rest.find('/'));
      MeshCorner& corner = corners.emplace_back(MeshCorner{index(vertex, mesh_.vertices.size(), "vertices")});
      if (coordinates_.empty() && coordinates.empty()) continue;
      if (coordinates.empty())
        mesh_.fail(line_, fmt::format("'{}': expected texture coordinates, which are those of the pattern (v/vt)",
                                      base::quoted(text)));
      const int place = index(coordinates, coordinates_.size(), "texture coordinates");
      corner.place = place_of(corner.vertex, coordinates_[static_cast<std::size_t>(place)]);
    }
    add_polygon(mesh_, corners, line_);
  }

  GarmentMesh mesh_;
  std::vector<Eigen::Vector2d> coordinates_;
  std::map<std::tuple<int, double, double>, int> places_;
  int line_ = 0;
};

}  // namespace

void GarmentMesh::fail(int line, const std::string& what) const {
  throw SceneError(fmt::format("{}{}{}: {}", file, has_lines ? ":" : ": face ", line, what));
}

void add_polygon(GarmentMesh& mesh, const std::vector<MeshCorner>& corners, int line) {
  if (corners.size() < 3) mesh.fail(line, "expected a face of at least three corners");
  for (std::size_t k = 2; k < corners.size(); ++k) {
    const MeshCorner &a = corners[0], &b = corners[k - 1], &c = corners[k];
    mesh.faces.push_back({{a.vertex, b.vertex, c.vertex}, {a.place, b.place, c.place}, line});
  }
}

GarmentMesh read_obj(const std::string& file) { return ObjReader(file).read(pattern_text(file)); }

}  // namespace drape::model
