#pragma once

#include <string>
#include <type_traits>
#include <utility>

#include "bench/runs/checkpoint_json.hpp"
#include "bench/runs/interruption.hpp"
#include "bench/runs/machine_lock.hpp"
#include "bench/runs/progress.hpp"
#include "bench/runs/shard.hpp"
#include "results/file/journal.hpp"

namespace drape::bench {

/// Checkpoints of a sweep: each piece of work has an id that is the same in every process, and a restarted sweep takes the
/// results of finished pieces from the journal. Also shows the progress of the sweep.
class Checkpoint {
 public:
  /// `parts`: how often advance() will be called. `shards`: with whom the sweep is shared, if it is; `machine`: its lock, if
  /// this computes a shard.
  Checkpoint(results::Journal& journal, int parts, Shards* shards = nullptr, MachineLock* machine = nullptr)
      : journal_(journal), progress_(parts), shards_(shards), machine_(machine) {}

  /// The ids that follow belong to this job, or part of one.
  void begin(const std::string& part) { prefix_ = part + ": "; }

  void show(const std::string& activity) { progress_.show(activity); }
  void report(const std::string& activity) { progress_.report(activity); }
  void note(const std::string& line) { progress_.note(line); }
  void advance() { progress_.advance(); }

  /// What compute() returns, or what it returned to a process before this one: something that json holds. A result during which
  /// the sweep was interrupted is not kept: it may be cut short. Throws ComputedElsewhere if it is another shard's and not
  /// there yet.
  template <class Compute>
  std::invoke_result_t<Compute> once(const std::string& id, const Compute& compute) {
    return kept<std::invoke_result_t<Compute>>(id, [&] {
      if (machine_ != nullptr) machine_->beside_others();  // lets those go first who wait to be alone
      return compute();
    });
  }

  /// The same of what measures times: meanwhile no other shard on this machine computes.
  template <class Compute>
  std::invoke_result_t<Compute> timed(const std::string& id, const Compute& compute) {
    return kept<std::invoke_result_t<Compute>>(id, [&] {
      if (machine_ != nullptr) machine_->alone();
      auto result = compute();
      if (machine_ != nullptr) machine_->beside_others();
      return result;
    });
  }

  /// Does something with each of a list, none of which needs the results of another. Shards share these; what is done with one
  /// of them belongs together, as does what is outside of such lists in a job. Where others are to compute some, this does the
  /// rest of the list before it throws ComputedElsewhere.
  template <class List, class Body>
  void each(List&& list, const Body& body) {
    const std::string outer = std::exchange(key_, "");
    bool complete = true;
    for (auto&& item : list) {
      key_.clear();
      try {
        body(item);
      } catch (const ComputedElsewhere&) {
        complete = false;
      }
    }
    key_ = outer;
    if (!complete) throw ComputedElsewhere();
  }

 private:
  const results::Journal::Bytes* find(const std::string& id) const {
    const auto* known = journal_.find(id);
    return known != nullptr || shards_ == nullptr ? known : shards_->find(id);
  }

  template <class Result>
  Result kept(const std::string& name, const auto& compute) {
    const std::string id = prefix_ + name;
    if (key_.empty()) key_ = id;
    if (const auto* known = find(id)) return nlohmann::json::from_cbor(*known).template get<Result>();
    if (shards_ != nullptr) shards_->require_own(id, key_);
    check_interruption();
    Result result = compute();
    check_interruption();
    journal_.add(id, nlohmann::json::to_cbor(nlohmann::json(result)));
    return result;
  }

  results::Journal& journal_;
  Progress progress_;
  Shards* shards_;
  MachineLock* machine_;
  std::string prefix_;
  std::string key_;  ///< that decides whose shard it is: the first id of what belongs together
};

}  // namespace drape::bench
