#pragma once

#include <optional>
#include <vector>

#include "bench/runs/observer.hpp"
#include "results/run_record.hpp"

namespace drape::bench {

/// Gathers what obstacles do to a run. Costs nothing where there are none.
class ContactObserver : public Observer {
 public:
  void begin(const model::Scene& scene, const model::Cloth& cloth, const solver::State& start) override;
  void observe(const solver::StepReport& step) override { see(step.t, step.y); }

  /// Nothing if the scene has no obstacles, or the run no start.
  std::optional<results::ContactRecord> result() const { return record_; }

 private:
  void see(double t, const solver::State& y);

  const model::Scene* scene_ = nullptr;
  const model::Cloth* cloth_ = nullptr;
  std::optional<results::ContactRecord> record_;
  double start_ = 0, least_ = 0, scale_ = 0, rise_ = 0;  ///< energies [J]
};

/// What is at most this part of d away is in contact: a twentieth of d away from the collision area.
constexpr double contact_reach = 1.05;

/// Which particles are in contact. Empty without obstacles.
std::vector<bool> in_contact(const model::Scene& scene, const model::Cloth& cloth, double t, const solver::Vectors& x);

/// Area of the particles in contact, over that of the sheet.
double contact_area(const model::Scene& scene, const model::Cloth& cloth, double t, const solver::Vectors& x);

}  // namespace drape::bench
