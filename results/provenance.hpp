#pragma once

#include <string>
#include <string_view>
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

/// The value of the fact with this name, "unknown" if there is none.
std::string value_of(const Provenance& facts, std::string_view name);

/// What this program was built from and with, the machine it runs on, the time of this call and the command line it was
/// started with. What cannot be found out is "unknown". `sweep`: identity of what is computed, so that a file is continued by
/// nothing else.
Provenance provenance(std::string command_line, std::string sweep = "none");

/// From now on this is a part of provenance(): what else computes results.
void also_made_by(Fact fact);

/// Whether a sweep starts from the beginning or continues what a process before it has recorded, if there is something.
enum class Start { fresh, resumed };

/// The facts that all processes share which may write parts of the same sweep: all but time and command line of the start and
/// what a reboot may change.
Provenance lasting(const Provenance& provenance);

/// Says which of these facts differs: then results must not be mixed. Empty if none does.
std::string why_not_resumed(const Provenance& theirs, const Provenance& ours);

/// UTC, ISO 8601.
std::string time_of_day();

}  // namespace drape::results
