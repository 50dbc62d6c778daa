#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <vector>

namespace drape::base {

/// What a computation in a process of its own may use beyond what this process has.
struct SandboxLimits {
  std::size_t bytes = 0;  ///< of memory
  double cpu_seconds = 0;
};

/// Why a process of its own has given nothing: what an exception in it said.
struct SandboxError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The limit or signal that ended it.
struct SandboxEnded : SandboxError {
  using SandboxError::SandboxError;
};

/// Memory of this process that counts against RLIMIT_DATA [bytes].
std::size_t data_held();

/// What `compute` returns in a copy of this process, so that code which crashes, loops or takes all memory on hostile input
/// ends that copy and nothing else. `compute` must need no other thread, and what it changes is not seen here. Throws
/// SandboxError or SandboxEnded.
std::vector<std::byte> in_sandbox(const std::function<std::vector<std::byte>()>& compute, const SandboxLimits& limits);

}  // namespace drape::base
