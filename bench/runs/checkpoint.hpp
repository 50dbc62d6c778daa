#pragma once

#include <string>
#include <type_traits>

#include "bench/runs/checkpoint_json.hpp"
#include "bench/runs/interruption.hpp"
#include "bench/runs/progress.hpp"
#include "results/file/journal.hpp"

namespace drape::bench {

/// Checkpoints of a sweep: each piece of work has an id that is the same in every process, and a restarted sweep takes the
/// results of finished pieces from the journal. Also shows the progress of the sweep.
class Checkpoint {
 public:
  /// `parts`: how often advance() will be called.
  Checkpoint(results::Journal& journal, int parts) : journal_(journal), progress_(parts) {}

  /// The ids that follow belong to this job, or part of one.
  void begin(const std::string& part) { prefix_ = part + ": "; }

  void show(const std::string& activity) { progress_.show(activity); }
  void report(const std::string& activity) { progress_.report(activity); }
  void note(const std::string& line) { progress_.note(line); }
  void advance() { progress_.advance(); }

  /// What compute() returns, or what it returned to a process before this one: something that json holds. A result during which
  /// the sweep was interrupted is not kept: it may be cut short.
  template <class Compute>
  std::invoke_result_t<Compute> once(const std::string& id, const Compute& compute) {
    using Result = std::invoke_result_t<Compute>;
    if (const auto* known = journal_.find(prefix_ + id)) return nlohmann::json::from_cbor(*known).get<Result>();
    check_interruption();
    Result result = compute();
    check_interruption();
    journal_.add(prefix_ + id, nlohmann::json::to_cbor(nlohmann::json(result)));
    return result;
  }

 private:
  results::Journal& journal_;
  Progress progress_;
  std::string prefix_;
};

}  // namespace drape::bench
