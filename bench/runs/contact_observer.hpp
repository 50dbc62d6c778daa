#pragma once

#include <vector>

#include "model/cloth.hpp"
#include "results/run_record.hpp"

namespace drape::bench {

/// Gathers what obstacles do to a run while it runs.
class ContactWatch {
 public:
  ContactWatch(const model::Scene& scene, const model::Cloth& cloth);

  /// A state with its kinetic and potential energy [J]; the first is the start.
  void see(double t, const solver::State& y, double kinetic, double potential);

  /// Nothing if the scene has no obstacles.
  std::optional<results::ContactRecord> result() const;

 private:
  const model::Scene& scene_;
  const model::Cloth& cloth_;
  results::ContactRecord record_;
  double start_ = 0, least_ = 0, scale_ = 0, rise_ = 0;  ///< energies [J]
  bool begun_ = false;
};

/// Which particles are in contact: at most a twentieth of d away from the collision area. Empty without obstacles.
std::vector<bool> in_contact(const model::Scene& scene, const model::Cloth& cloth, double t, const solver::Vectors& x);

/// Area of the particles in contact, over that of the sheet.
double contact_area(const model::Scene& scene, const model::Cloth& cloth, double t, const solver::Vectors& x);

}  // namespace drape::bench
