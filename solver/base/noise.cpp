#include "solver/base/noise.hpp"

#include <cstdint>

namespace drape::base {

Eigen::VectorXd noise(Eigen::Index size, unsigned seed) {
  std::uint64_t state = seed;
  return Eigen::VectorXd::NullaryExpr(size, [&](Eigen::Index) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;  // Knuth's linear congruential generator
    return 2 * (static_cast<double>(state >> 11) / double(1ULL << 53)) - 1;
  });
}

}  // namespace drape::base
