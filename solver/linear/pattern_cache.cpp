#include "solver/linear/pattern_cache.hpp"

#include <atomic>

namespace drape::solver {
namespace {

std::atomic<std::int64_t> computed = 0, shared = 0;

}  // namespace

PatternCounts pattern_counts() { return {computed, shared}; }

void detail::count_pattern(bool is_shared) { ++(is_shared ? shared : computed); }

}  // namespace drape::solver
