#include "solver/base/threads.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace drape::base {
namespace {

int allowed = 1;

}  // namespace

void use_threads(int threads) {
  if (threads < 1 || threads > max_threads)
    throw std::invalid_argument("threads: expected a number from 1 to " + std::to_string(max_threads));
  allowed = threads;
}

int threads_for(std::int64_t particles) { return particles >= 40000 ? allowed : 1; }

int threads_for_lines(int lines, std::int64_t particles) {
  constexpr int least = 16;  // lines of a thread
  return std::clamp(lines / least, 1, threads_for(particles));
}

}  // namespace drape::base
