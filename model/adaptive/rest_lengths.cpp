#include "model/adaptive/rest_lengths.hpp"

#include <stdexcept>

namespace drape::model {

std::vector<double> split_rest_length(double rest, std::span<const Eigen::Vector3d> chain) {
  std::vector<double> parts;
  double whole = 0;
  for (std::size_t k = 1; k < chain.size(); ++k) whole += parts.emplace_back((chain[k] - chain[k - 1]).norm());
  if (!(whole > 0)) throw std::invalid_argument("an edge with virtual particles: expected ends that are apart");
  double left = rest;
  for (std::size_t k = 0; k + 1 < parts.size(); ++k) {
    const double share = rest + rest * (parts[k] / whole);
    parts[k] = share - rest;  // without the digits below those of `rest`
    left -= parts[k];
  }
  parts.back() = left;
  return parts;
}

}  // namespace drape::model
