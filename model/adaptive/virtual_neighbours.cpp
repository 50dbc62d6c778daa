#include "model/adaptive/virtual_neighbours.hpp"

#include <algorithm>
#include <map>

#include "model/adaptive/rest_lengths.hpp"

namespace drape::model {

VirtualNeighbours::VirtualNeighbours(const EdgeMesh& sheet, std::span<const Edge> springs) : along_(sheet.edges().size()) {
  std::map<std::array<int, 2>, int> numbers;
  for (const EdgeMesh::Edge& edge : sheet.edges()) {
    const auto [low, high] = std::minmax(edge.ends[0], edge.ends[1]);
    numbers[{low, high}] = static_cast<int>(ends_.size());
    ends_.push_back(edge.ends);
  }
  for (int s = 0; s < std::ssize(springs); ++s) {
    const auto [low, high] = std::minmax(springs[s].i, springs[s].j);
    if (const auto found = numbers.find({low, high}); found != numbers.end())
      along_[found->second] = {s, springs[s].i == ends_[found->second][0], springs[s].length};
  }
}

std::vector<DividedSpring> VirtualNeighbours::find(const Vectors& x, const Insertion& insertion) const {
  std::vector<DividedSpring> divided;
  std::vector<Eigen::Vector3d> chain;
  for (const HitEdge& hit : insertion.edges) {
    const Along& along = along_[hit.edge];
    if (along.spring < 0) continue;
    const auto particle = [&](int number) { return insertion.particles[number - x.rows()]; };
    chain.assign(1, x.row(ends_[hit.edge][0]));
    for (const int number : hit.particles) chain.push_back(particle(number).position);
    chain.emplace_back(x.row(ends_[hit.edge][1]));
    const std::vector<double> lengths = split_rest_length(along.length, chain);
    const VirtualNeighbour first{particle(hit.particles.front()), lengths.front()};
    const VirtualNeighbour last{particle(hit.particles.back()), lengths.back()};
    divided.push_back({along.spring, along.forward ? first : last, along.forward ? last : first});
  }
  return divided;
}

}  // namespace drape::model
