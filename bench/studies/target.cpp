#include "bench/studies/target.hpp"

#include <fmt/format.h>

namespace drape::bench {

std::string to_string(const Target& target) { return fmt::format("{} {:g}", target.at_least ? ">=" : "<=", target.wanted); }

results::Verdict check(const Target& target, double value) {
  const double by = target.at_least ? target.wanted / value : value / target.wanted;
  return results::check(by <= 1, "", fmt::format("not met by {:.2f}", by));
}

}  // namespace drape::bench
