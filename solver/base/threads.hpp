#pragma once

#include <cstdint>

namespace drape::base {

inline constexpr int max_threads = 64;

/// Sets how many threads the linear algebra of large grids may use (1 … max_threads; 1 unless set), for the whole process as
/// OpenMP's own settings. Throws std::invalid_argument for other numbers.
void use_threads(int threads);

/// Threads that pay for a field of this number of particles.
int threads_for(std::int64_t particles);

}  // namespace drape::base
