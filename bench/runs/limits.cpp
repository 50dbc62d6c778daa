#include "bench/runs/limits.hpp"

#include <fmt/format.h>
#include <malloc.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <system_error>

#include "bench/runs/interruption.hpp"
#include "solver/base/sandbox.hpp"

namespace drape::bench {
namespace {

using Clock = std::chrono::steady_clock;

rlimit limit_of_data() {
  rlimit limit{};
  if (getrlimit(RLIMIT_DATA, &limit) != 0) throw std::system_error(errno, std::generic_category(), "memory limit");
  return limit;
}

void limit_data(rlim_t bytes) {
  const rlimit limit{std::min(bytes, limit_of_data().rlim_max), limit_of_data().rlim_max};
  if (setrlimit(RLIMIT_DATA, &limit) != 0) throw std::system_error(errno, std::generic_category(), "memory limit");
}

}  // namespace

void watch(solver::SplitOde& ode, double seconds) {
  const auto begin = Clock::now();
  const auto watched = [=](auto inner) {
    return [=](auto&&... arguments) {
      check_interruption();
      if (std::chrono::duration<double>(Clock::now() - begin).count() > seconds)
        throw OutOfTime(fmt::format("longer than {:g} s", seconds));
      inner(arguments...);
    };
  };
  ode.force = watched(ode.force);
  ode.explicit_force = watched(ode.explicit_force);
  ode.jacobian = watched(ode.jacobian);
  ode.newton_matrix = watched(ode.newton_matrix);
}

MemoryLimit::MemoryLimit(double megabytes) : before_(limit_of_data()) {
  if (!std::isfinite(megabytes)) return;
  malloc_trim(0);  // or what earlier cells have freed would be at this one's disposal
  limit_data(base::data_held() + static_cast<rlim_t>(megabytes * 1024 * 1024));
}

MemoryLimit::~MemoryLimit() {
  setrlimit(RLIMIT_DATA, &before_);  // raising a soft limit to where it was cannot fail
}

}  // namespace drape::bench
