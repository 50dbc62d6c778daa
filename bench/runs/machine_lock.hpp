#pragma once

#include "solver/base/descriptor.hpp"

namespace drape::bench {

/// Keeps the shards of a machine apart: where one measures times, no other one computes. Held as long as this lives.
class MachineLock {
 public:
  /// Waits until no shard measures times. Throws FileError if there is no lock to be had.
  MachineLock();

  /// Waits until all others are between two checkpoints, and keeps them there until beside_others().
  void alone();
  void beside_others();

 private:
  base::Descriptor file_;
};

}  // namespace drape::bench
