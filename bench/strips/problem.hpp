#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/scene.hpp"

namespace drape::bench::strips {

/// What the program bench_strips reads from problem.json.
struct Problem {
  std::string scene = {};                 ///< TOML
  std::string method = {};                ///< one of methods()
  double step = 0;                        ///< [s]
  int steps = 0;                          ///< in all
  std::string stage_solver = "anderson";  ///< of methods with nonlinear stages
  double tolerance = 1e-8;                ///< relative, of SUNDIALS
  std::vector<int> lines = {};            ///< of each process; empty: as equal as possible
  bool writes_state = false;              ///< whether the end is written to `state_file`: 3N positions, then 3N velocities
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Problem, scene, method, step, steps, stage_solver, tolerance, lines,
                                                writes_state)

/// The methods that strips are stepped by, ours and SUNDIALS'.
std::span<const std::string_view> methods();
bool is_of_sundials(std::string_view method);

/// Throws std::invalid_argument, naming the key and what would be right.
void check(const Problem& problem, const model::Scene& scene);

constexpr char state_file[] = "state";

/// What a process has sent, the messages of all libraries included.
struct Traffic {
  std::int64_t messages = 0;    ///< to one other process each
  std::int64_t bytes = 0;       ///< in these
  std::int64_t reductions = 0;  ///< in which all processes take part

  Traffic& operator+=(const Traffic& other) {
    messages += other.messages, bytes += other.bytes, reductions += other.reductions;
    return *this;
  }
  Traffic operator-(const Traffic& other) const {
    return {messages - other.messages, bytes - other.bytes, reductions - other.reductions};
  }
  bool operator==(const Traffic&) const = default;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Traffic, messages, bytes, reductions)

/// A process.
struct Rank {
  int lines;
  Traffic first;  ///< of the first step, with estimates and matrices that later ones share
  Traffic later;  ///< of all others
  double memory;  ///< the most that it took [MB]
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Rank, lines, first, later, memory)

/// What it writes to solved.json.
struct Solved {
  std::string libraries;                     ///< with their versions
  std::vector<double> seconds;               ///< wall time of each step, of the slowest process
  std::map<std::string, std::int64_t> work;  ///< counters of the solver, which are those of every process
  std::vector<Rank> ranks;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Solved, libraries, seconds, work, ranks)

}  // namespace drape::bench::strips
