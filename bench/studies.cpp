#include "bench/studies.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace drape::bench {

std::span<const Study> studies() {
  static constexpr Study table[] = {
      {"hung-sheets",
       "all methods on the sheet of table 3.2 (without the table), hung by its edge and by two corners, d = 50 and 0.5",
       hung_sheets},
  };
  return table;
}

const Study& study(std::string_view name) {
  const auto all = studies();
  const auto found = std::ranges::find(all, name, &Study::name);
  if (found != all.end()) return *found;
  std::string message = "unknown study '" + std::string(name) + "': choose from";
  for (const Study& known : all) message += " " + std::string(known.name);
  throw std::invalid_argument(message);
}

}  // namespace drape::bench
