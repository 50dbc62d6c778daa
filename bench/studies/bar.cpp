#include "bench/studies/bar.hpp"

#include <fmt/format.h>

namespace drape::bench {

std::string to_string(const Bar& bar) { return fmt::format("{} {:g}", bar.at_least ? ">=" : "<=", bar.wanted); }

results::Verdict verdict(const Bar& bar, double value) {
  const double by = bar.at_least ? bar.wanted / value : value / bar.wanted;
  return by <= 1 ? results::Verdict{results::Standing::met}
                 : results::Verdict{results::Standing::missed, fmt::format("not met by {:.2f}", by)};
}

}  // namespace drape::bench
