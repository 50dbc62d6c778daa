#include "solver/base/threads.hpp"

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

}  // namespace drape::base
