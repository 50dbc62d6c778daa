#pragma once

#include <vector>

#include "model/collision/self_contacts.hpp"
#include "solver/contact/pair_search.hpp"

namespace drape::model {

/// Where a cloth of some thickness meets itself, for the solver.
class ClothPairs : public solver::PairSearch {
 public:
  /// `thickness`: distance between the middles of two layers that touch [m]; `friction`: Coulomb's coefficient.
  ClothPairs(ClothSurface surface, double thickness, double friction, solver::Counters& work);

  double thickness() const override { return thickness_; }
  double friction() const override { return friction_; }
  void find(const Vectors& x0, const Vectors& x1, double distance, std::vector<solver::PairContact>& found) override;
  void renew(const Vectors& x, std::vector<solver::PairContact>& pairs) const override;

 private:
  SelfContacts contacts_;
  double thickness_, friction_;
  std::vector<Approach> approaches_;
};

}  // namespace drape::model
