#include "model/adaptive/edge_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>

namespace drape::model {

EdgeMesh::EdgeMesh(const std::string& name, std::span<const std::array<int, 3>> triangles)
    : triangles_(triangles.begin(), triangles.end()), sides_(triangles.size()) {
  std::map<std::array<int, 2>, int> numbers;
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t)
    for (int k = 0; k < 3; ++k) {
      const int from = triangles_[t][k], to = triangles_[t][(k + 1) % 3];
      const auto [found, is_new] =
          numbers.try_emplace({std::min(from, to), std::max(from, to)}, static_cast<int>(edges_.size()));
      sides_[t][k] = found->second;
      if (is_new) {
        edges_.push_back({{from, to}, {t, -1}});
        continue;
      }
      Edge& edge = edges_[found->second];
      const auto fail = [&](const char* what) {
        throw std::invalid_argument(fmt::format("{}: {} at the edge from vertex {} to {}", name, what, from, to));
      };
      if (edge.triangles[1] >= 0) fail("expected at most two triangles");
      if (edge.ends[0] == from) fail("expected triangles that agree on which side is the front");
      edge.triangles[1] = t;
    }
}

}  // namespace drape::model
