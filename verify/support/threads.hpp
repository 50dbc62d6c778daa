#pragma once

#include "solver/base/threads.hpp"

namespace drape::verify {

/// Allows this number of threads during its lifetime.
struct Threads {
  explicit Threads(int threads) { base::use_threads(threads); }
  ~Threads() { base::use_threads(1); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;
};

}  // namespace drape::verify
