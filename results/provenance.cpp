#include "results/provenance.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>

#include <ctime>
#include <fstream>
#include <thread>
#include <utility>

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

}  // namespace

Provenance provenance(std::string command_line) {
  Provenance facts{
// Both are written by CMake: rows {name, value, description}.
#include "results/build_facts.inc"
#include "results/git_commit.inc"
  };
  facts.push_back({"cpu", cpu_model(), "model of the processor"});
  facts.push_back({"cores", std::to_string(std::thread::hardware_concurrency()), "number of cores this program may use"});
  facts.push_back({"host_os", operating_system(), "operating system, release and architecture of the host"});
  facts.push_back({"started", fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr))), "UTC time of the start (ISO 8601)"});
  facts.push_back({"command_line", std::move(command_line), "command line of the program that wrote this"});
  return facts;
}

}  // namespace drape::results
