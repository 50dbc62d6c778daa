#pragma once

#include <string>
#include <vector>

namespace drape::results {

/// One thing known of where results come from.
struct Fact {
  std::string name;
  std::string value;
  std::string description;
};

/// All that is known, in the order in which it is shown.
using Provenance = std::vector<Fact>;

/// What this program was built from and with, the machine it runs on, the time of this call and the command line it was
/// started with. What cannot be found out is "unknown".
Provenance provenance(std::string command_line);

}  // namespace drape::results
