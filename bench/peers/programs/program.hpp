#pragma once

#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>

#include "bench/peers/problem.hpp"

namespace drape::bench::peers {

/// The time that steps take [s], frames apart.
class StepClock {
 public:
  template <class Steps>
  void time(const Steps& steps) {
    const auto begin = Clock::now();
    steps();
    seconds_ += std::chrono::duration<double>(Clock::now() - begin).count();
  }
  double seconds() const { return seconds_; }

 private:
  using Clock = std::chrono::steady_clock;
  double seconds_ = 0;
};

/// main() of a program: reads FOLDER/problem.json and writes FOLDER/motion.json. What fails is said in one line.
inline int run_program(int argc, char** argv, Solved (*solve)(const Problem& problem)) {
  try {
    if (argc != 2) throw std::runtime_error("expected one argument, a folder with problem.json");
    const std::string folder = argv[1];
    std::ifstream in(folder + "/problem.json");
    const Solved solved = solve(nlohmann::json::parse(in).get<Problem>());
    std::ofstream out(folder + "/motion.json");
    out << nlohmann::json(solved);
    out.close();
    if (!out) throw std::runtime_error(folder + "/motion.json: cannot be written");
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

}  // namespace drape::bench::peers
