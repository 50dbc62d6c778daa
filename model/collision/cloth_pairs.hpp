#pragma once

#include <optional>
#include <vector>

#include "model/collision/body_contacts.hpp"
#include "model/collision/self_contacts.hpp"
#include "solver/contact/pair_search.hpp"

namespace drape::model {

/// Where a cloth meets itself, if it has a thickness, and where its faces meet bodies, for the solver.
class ClothPairs : public solver::PairSearch {
 public:
  /// `bodies`: those whose faces are met.
  ClothPairs(const ClothSurface& surface, const ContactRule& rule, std::span<const ObstacleRule> bodies,
             solver::Counters& work);

  void begin(double t, double h) override;
  const solver::BodyPoints& bodies() const override { return bodies_.points(); }
  bool rubs() const override { return rule_.self_friction > 0 || bodies_.rub(); }
  void find(const Vectors& x0, const Vectors& x1, double part, std::vector<solver::PairContact>& found) override;
  void renew(const Vectors& x, std::vector<solver::PairContact>& pairs) const override;

 private:
  std::optional<SelfContacts> self_;
  BodyContacts bodies_;
  ContactRule rule_;
  std::vector<Approach> approaches_;
};

}  // namespace drape::model
