#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "model/forces/fused/law.hpp"
#include "model/memory/term_memory.hpp"
#include "model/sheet/sheet.hpp"
#include "solver/split_ode.hpp"

namespace drape::model {

/// Arguments of forces. Positions, velocities and unit normals are N × 3; normals are empty if no term needs them.
struct Configuration {
  double t;
  const Vectors& x;
  const Vectors& v;
  const Vectors& normals;
};

/// The derivatives that a term adds to a matrix.
enum class Curvature {
  exact,  ///< all of them
  convex,  ///< a symmetric negative semidefinite part of every element, so that M − γ² ∂f/∂x − γ ∂f/∂v can be factored
  tension,  ///< the same without terms that couple more than the two ends of an edge
};

/// Takes 3 × 3 blocks of ∂f/∂x and ∂f/∂v: row particle i, column particle j. A term adds its blocks in an order that depends
/// on the grid and the curvature only.
struct JacobianEntries {
  using Add = std::function<void(int i, int j, const Eigen::Matrix3d& block)>;
  Curvature curvature;
  Add add_dx, add_dv;

  /// Rows [begin, end) are taken, others are not: another thread takes them.
  int begin = 0, end = std::numeric_limits<int>::max();
  std::function<void(int dx, int dv)> skip = {};  ///< leaves out as many blocks

  bool exact() const { return curvature == Curvature::exact; }

  /// Leaves out the blocks of an element with particles from `lowest` to `highest`, if no row of theirs is taken.
  bool skips(int lowest, int highest, int dx, int dv) const {
    if (lowest < end && highest >= begin) return false;
    skip(dx, dv);
    return true;
  }
};

/// One force of a compiled sheet [N]: coefficients of the law of the grid, which is evaluated for all terms together and gives
/// K and D; or a function that adds to the law's forces.
struct Term {
  GridLaw law;
  std::function<void(const Configuration&, Vectors& f)> force;                 ///< all of it explicit; absent: none
  std::function<double(const Vectors& x)> energy;                              ///< [J]; absent: none
  std::function<void(const Configuration&, const JacobianEntries&)> jacobian;  ///< of law and force; absent: zero
  bool jacobian_in_threads = false;  ///< whether it may be called by several threads at the same time

  /// Adds to the force in the middle of x0 and x1 what the mean force between them has more (SplitOde::mean_excess); absent:
  /// nothing, as where the energy is at most quadratic.
  std::function<void(const Vectors& x0, const Vectors& x1, Vectors& f)> mean_excess;

  /// Adds the pull of its memory's part of K; absent: there is none. With `force` it is all of it.
  std::function<void(const Vectors& x, Vectors& f)> springs;

  std::shared_ptr<TermMemory> memory;  ///< what `force` remembers, with the energy that it stores; null: nothing

  GridLaw active_law;           ///< part of `law` that neither has an energy nor only dissipates
  bool active = false;          ///< whether `force` neither has an energy nor only dissipates
  bool without_energy = false;  ///< whether it has an elastic part that has no mean force, as where it has no `energy`

  /// Adds the compliant constraints that stand for all of `law` except `unconstrained_law`; absent: none, they stand for
  /// nothing.
  std::function<void(std::vector<solver::CompliantConstraint>& all)> list_constraints;
  GridLaw unconstrained_law;
  bool needs_normals = false;

  /// The part of `law` that no constraint stands for.
  const GridLaw& law_without_constraints() const { return list_constraints ? unconstrained_law : law; }
};

/// A number that a scene gives a force that was added, by the key forces.FORCE.NAME.
struct ForceParameter {
  enum class Range { any, non_negative, positive };
  std::string_view name;  ///< small letters, digits and '-'
  std::string_view unit;  ///< "1": a number without dimension
  std::string_view description;
  Range range = Range::any;
  double usual = 0;  ///< its value where a scene has the force and does not say
};

/// A row of the table of forces. Those that were added to the model's own have parameters.
struct TermKind {
  std::string_view name;
  std::string_view description;

  /// Returns nothing if the sheet does not have the force. Those that were added throw std::invalid_argument if it cannot have
  /// it. `parameters`: the values of those of the row.
  std::optional<Term> (*make)(const Sheet&, std::span<const double> parameters);
  std::span<const ForceParameter> parameters = {};
};

/// All forces, those that were added last.
std::span<const TermKind> term_kinds();

/// Adds a row for as long as the program runs; what it points to must stay. To be called before forces are used.
void add_term_kind(const TermKind& row);

/// The rows of term_kinds() that a sheet may have: the model's own, and those added that it names. Throws
/// std::invalid_argument if one of these is not there.
std::vector<TermKind> term_kinds_of(const Sheet& sheet);

/// The force of one of these rows; nothing if the sheet does not have it. Throws std::invalid_argument, naming the force, if it
/// was added and the sheet cannot have it.
std::optional<Term> make_term(const TermKind& kind, const Sheet& sheet);

}  // namespace drape::model
