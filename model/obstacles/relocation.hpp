#pragma once

#include <vector>

#include "model/obstacles/contacts.hpp"

namespace drape::model {

/// Responses that change positions and velocities after a step, of the particles that are in the collision area then: they are
/// moved to its border along the normal n, and the normal part v_n of their velocities becomes, w being the obstacle's,
///
///     reposition:  w_n                   [Etzmuß 2002, 4.1]
///     reflect:     w_n − e (v_n − w_n)   [Eberhardt, Weber, Straßer 1996; Etzmuß 2002, 4.2]
///     impulse:     w_n − h F_n / m       [Provot 1997; Etzmuß 2002, 4.2]
///
/// unless they leave already. F = m (v − v⁻)/h estimates the force of the step, v⁻ being the velocity when it began, as far as
/// it presses: what is set counteracts it in the next step. None has friction. Only rays test anything on the way: by
/// half-spaces thin obstacles may be passed.
class Relocation {
 public:
  Relocation(std::shared_ptr<Contacts> contacts, const ContactRule& rule);

  /// SplitOde::relocate.
  bool operator()(double t, double h, const solver::State& y0, solver::State& y1);

 private:
  std::shared_ptr<Contacts> contacts_;
  ContactRule rule_;
  std::vector<Depth> inside_;
  Vectors found_;  ///< positions before they are changed
};

}  // namespace drape::model
