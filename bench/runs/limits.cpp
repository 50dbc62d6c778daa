#include "bench/runs/limits.hpp"

#include <fmt/format.h>
#include <malloc.h>

#include <cerrno>
#include <cmath>
#include <system_error>

#include "bench/runs/interruption.hpp"
#include "solver/base/sandbox.hpp"

namespace drape::bench {
namespace {

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

Meter::Meter(const Limits& limits) : limits_(limits) {}

void Meter::end(solver::Outcome outcome, const std::string& message) { throw reached_.emplace(outcome, message); }

void Meter::check() {
  check_interruption();
  if (!std::isfinite(limits_.seconds)) return;
  if (std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count() > limits_.seconds)
    end(solver::Outcome::out_of_time, fmt::format("longer than {:g} s", limits_.seconds));
}

void Meter::count() {
  check();
  if (++evaluations_ > limits_.evaluations)
    end(solver::Outcome::out_of_evaluations, fmt::format("more than {} evaluations", limits_.evaluations));
}

void Meter::watch(solver::SplitOde& ode) {
  const auto counted = [this](auto inner) {
    return [this, inner = std::move(inner)](auto&&... arguments) {
      count();
      inner(arguments...);
    };
  };
  ode.force = counted(ode.force);
  ode.explicit_force = counted(ode.explicit_force);
  if (ode.unconstrained_force) ode.unconstrained_force = counted(ode.unconstrained_force);
  ode.newton_matrix = [this, inner = counted(ode.newton_matrix)](auto&&... arguments) {
    ++newton_matrices_;
    inner(arguments...);
  };
  ode.jacobian = [this, inner = ode.jacobian](auto&&... arguments) {
    check();
    inner(arguments...);
  };
}

MemoryLimit::MemoryLimit(double megabytes) : before_(limit_of_data()) {
  if (!std::isfinite(megabytes)) return;
  malloc_trim(0);  // or what earlier runs have freed would be at this one's disposal
  limit_data(base::data_held() + static_cast<rlim_t>(megabytes * 1024 * 1024));
}

MemoryLimit::~MemoryLimit() {
  setrlimit(RLIMIT_DATA, &before_);  // raising a soft limit to where it was cannot fail
}

}  // namespace drape::bench
