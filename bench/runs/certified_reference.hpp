#pragma once

#include "bench/runs/reference_work.hpp"
#include "reference/cache.hpp"
#include "results/run_record.hpp"

namespace drape::bench {

/// Times [s] at which motions are compared with the reference of a scene: all tenths of its end. The uncertainty or the error
/// at a single time may be small by chance.
std::vector<double> compared_times(const model::Scene& scene);

/// References of scenes, from the cache where they or tighter ones are known.
class References {
 public:
  static constexpr double loosest = 1e-9;

  /// `agreement`: largest disagreement of the two families, over the size of the scene. `rtol`: the tolerance to begin with,
  /// which is tightened, down to 1e-12, where they disagree by more than what is asked for. Its time begins now.
  explicit References(double agreement, ReferenceWatch watch = {}, double rtol = loosest)
      : agreement_(agreement), rtol_(rtol), watch_(std::move(watch)) {}

  /// Says what went wrong with the cache.
  ~References();
  References(const References&) = delete;
  References& operator=(const References&) = delete;

  /// At compared_times(). Throws reference::ReferenceError if there is none, and reference::NotCertified, naming the scene, if
  /// it cannot be trusted.
  reference::Reference operator()(const model::Scene& scene, const model::Cloth& cloth);

  /// The same at other times [s], which ascend.
  reference::Reference operator()(const model::Scene& scene, const model::Cloth& cloth, const std::vector<double>& times);

  /// The same with an uncertainty of at most a tenth of `error`, over the size, where perturbations do not grow and a tolerance
  /// of 1e-12 suffices; else the best there is.
  reference::Reference resolving(const model::Scene& scene, const model::Cloth& cloth, double error);

 private:
  using Clock = std::chrono::steady_clock;

  reference::Reference certified(const model::Scene& scene, const model::Cloth& cloth, const std::vector<double>& times,
                                 double uncertainty);
  reference::Reference tight(const model::Scene& scene, const model::Cloth& cloth, const std::vector<double>& times,
                             double uncertainty);
  reference::Reference at(double tolerance, const model::Scene& scene, const model::Cloth& cloth,
                          const std::vector<double>& times, double seconds);

  double agreement_, rtol_;
  ReferenceWatch watch_;
  Clock::time_point begin_ = Clock::now();
  reference::Cache cache_;
};

/// Distance of a run's final state from a reference of its scene that ends at the same time.
results::ErrorRecord distance(const results::RunRecord& run, const reference::Reference& reference, const model::Scene& scene,
                              const model::Cloth& cloth);

}  // namespace drape::bench
