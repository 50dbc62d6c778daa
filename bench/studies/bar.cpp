#include "bench/studies/bar.hpp"

#include <fmt/format.h>

#include "results/verdict.hpp"

namespace drape::bench {

std::string to_string(const Bar& bar) { return fmt::format("{} {:g}", bar.at_least ? ">=" : "<=", bar.wanted); }

std::string verdict(const Bar& bar, double value) {
  const double by = bar.at_least ? bar.wanted / value : value / bar.wanted;
  return by <= 1 ? results::verdict(results::Standing::met)
                 : results::verdict(results::Standing::missed, fmt::format("not met by {:.2f}", by));
}

}  // namespace drape::bench
