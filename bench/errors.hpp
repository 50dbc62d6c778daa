#pragma once

#include "model/cloth.hpp"
#include "reference/cache.hpp"
#include "results/run_record.hpp"

namespace drape::bench {

/// Times [s] at which motions are compared with the reference of a scene: all tenths of its end. The uncertainty or the error
/// at a single time may be small by chance.
std::vector<double> compared_times(const model::Scene& scene);

/// References of scenes, from the cache where they are known.
class References {
 public:
  /// `agreement`: largest disagreement of the two families, over the size of the scene. `rtol`: their tolerance.
  explicit References(double agreement, double rtol = reference::SolveOptions().rtol) : agreement_(agreement), rtol_(rtol) {}

  /// Says what went wrong with the cache.
  ~References();
  References(const References&) = delete;
  References& operator=(const References&) = delete;

  /// At compared_times(). Throws reference::ReferenceError if there is none, and reference::NotCertified, naming the scene, if
  /// it cannot be trusted.
  reference::Reference operator()(const model::Scene& scene, const model::Cloth& cloth);

  /// The same at other times [s], which ascend.
  reference::Reference operator()(const model::Scene& scene, const model::Cloth& cloth, const std::vector<double>& times);

 private:
  double agreement_, rtol_;
  reference::Cache cache_;
};

/// Distance of a run's final state from a reference of its scene that ends at the same time.
results::ErrorRecord distance(const results::RunRecord& run, const reference::Reference& reference, const model::Scene& scene,
                              const model::Cloth& cloth);

}  // namespace drape::bench
