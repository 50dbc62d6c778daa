#include "reference/exact/tension.hpp"

namespace drape::reference {

double pulled_position(const PulledSheet& sheet, double X) {
  const auto [L, k, f] = sheet;
  return X + f / k * (L * X - X * X / 2);
}

}  // namespace drape::reference
