#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

namespace drape::solver {

/// Counts the work of a run, one counter per kind. Every kind that could occur is registered with 0 before the run, so that
/// work that was not needed is recorded as 0. Counters are exact and repeatable where times are not.
class Counters {
 public:
  struct Kind {
    std::string name;         ///< for example "cg_iterations" or "force/tension"
    std::string description;  ///< what one count stands for
    std::int64_t count = 0;
  };

  Counters() = default;
  Counters(const Counters&) = delete;  // callers keep references to the counters
  Counters& operator=(const Counters&) = delete;

  /// Registers a kind (once; later calls return the same counter). The reference stays valid as long as this object.
  std::int64_t& counter(std::string_view name, std::string_view description);

  /// The count of a kind. Throws std::out_of_range if it was never registered.
  std::int64_t count(std::string_view name) const;

  const std::deque<Kind>& kinds() const { return kinds_; }

 private:
  std::deque<Kind> kinds_;
};

}  // namespace drape::solver
