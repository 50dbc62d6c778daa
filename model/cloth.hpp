#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/garment.hpp"
#include "model/obstacles/contacts.hpp"

namespace drape::model {

/// What exists in a compiled scene, decided once: the rest costs nothing.
struct Plan {
  std::vector<std::string> terms;           ///< forces with nonzero coefficients
  std::vector<std::string> without_energy;  ///< those that are elastic and have no mean force: no energy, or a difficult one
  bool normals = false;                     ///< whether any of them asks for normals
  int particles = 0;
  int pinned_dofs = 0;  ///< of 3N
  int obstacles = 0;
  int internal_variables = 0;  ///< of forces that remember the motion
  int stiffness_entries = 0, damping_entries = 0;
};

/// A scene ready to be integrated. Particles of the solver are the nodes of the garment.
struct Cloth {
  std::shared_ptr<const Garment> garment;
  solver::SplitOde ode;
  double begin = 0;  ///< the time of its start [s]
  solver::State start;
  Plan plan;
  std::shared_ptr<Contacts> contacts;  ///< null without obstacles

  /// The force [N] whose work along the motion is what the sheet is given beside its energies and by damping: of forces that
  /// are neither a gradient nor purely dissipative, of obstacles that act by forces, and minus the whole force where pins move.
  /// Absent if there is nothing of it.
  solver::SplitOde::Force given;
};

/// Compiles a scene, of several phases (model/phases.hpp) the first: only forces with nonzero coefficients are built, and
/// normals only if one of these asks for them.
Cloth compile(const Scene& scene);

/// Compiles one phase from a state. Its work is added to these counters.
Cloth compile(const Scene& phase, std::shared_ptr<const Garment> garment, solver::State start,
              std::shared_ptr<solver::Counters> work);

/// Plan::without_energy of a scene that is not compiled.
std::vector<std::string> forces_without_energy(const Scene& scene);

/// The plan in one line, for users.
std::string to_string(const Plan& plan);

}  // namespace drape::model
