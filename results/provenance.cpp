#include "results/provenance.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <fstream>
#include <iterator>
#include <string_view>
#include <thread>
#include <utility>

#include "solver/base/hash.hpp"

namespace drape::results {
namespace {

std::string cpu_model() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string operating_system() {
  utsname host{};
  return uname(&host) == 0 ? fmt::format("{} {} {}", host.sysname, host.release, host.machine) : "unknown";
}

/// Checksum of the file that this process runs: what was changed without a commit shows here.
std::string program_hash() {
  std::ifstream file("/proc/self/exe", std::ios::binary | std::ios::ate);
  if (!file) return "unknown";
  std::string bytes(static_cast<std::size_t>(file.tellg()), '\0');  // read as a whole: with debug information it is 100 MB
  file.seekg(0);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return base::hash_text(bytes);
}

std::vector<Fact>& further_makers() {
  static std::vector<Fact> facts;
  return facts;
}

constexpr std::array<std::string_view, 6> of_a_start{"started", "command_line", "cores", "host_os", "resumed", "finished"};

}  // namespace

std::string time_of_day() { return fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr))); }

std::string value_of(const Provenance& facts, std::string_view name) {
  const auto fact = std::ranges::find(facts, name, &Fact::name);
  return fact == facts.end() ? "unknown" : fact->value;
}

Provenance lasting(const Provenance& provenance) {
  Provenance facts = provenance;
  std::erase_if(facts, [](const Fact& fact) { return std::ranges::find(of_a_start, fact.name) != of_a_start.end(); });
  return facts;
}

std::string why_not_resumed(const Provenance& theirs, const Provenance& ours) {
  for (const auto& [name, value, description] : lasting(ours)) {
    const std::string other = value_of(theirs, name);
    if (other == value) continue;
    if (name == "sweep") return "it holds something else than what is asked for";
    return fmt::format("it was written by another program or machine: {} is {} there and {} here", name, other, value);
  }
  return {};
}

void also_made_by(Fact fact) { further_makers().push_back(std::move(fact)); }

Provenance provenance(std::string command_line, std::string sweep) {
  Provenance facts{
// Both are written by CMake: rows {name, value, description}.
#include "results/build_facts.inc"
#include "results/git_commit.inc"
  };
  facts.push_back({"program_hash", program_hash(), "hash of the program file"});
  std::ranges::copy(further_makers(), std::back_inserter(facts));
  facts.push_back({"cpu", cpu_model(), "model of the processor"});
  facts.push_back({"cores", std::to_string(std::thread::hardware_concurrency()), "number of cores this program may use"});
  facts.push_back({"host_os", operating_system(), "operating system, release and architecture of the host"});
  facts.push_back({"started", time_of_day(), "UTC time of the start (ISO 8601)"});
  facts.push_back({"command_line", std::move(command_line), "command line of the program that wrote this"});
  facts.push_back({"sweep", std::move(sweep), "identity of what was asked for: hash of all that determines it"});
  return facts;
}

}  // namespace drape::results
