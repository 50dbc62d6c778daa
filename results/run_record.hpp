#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "solver/outcome.hpp"
#include "solver/state.hpp"

namespace drape::results {

/// A number with its unit and meaning, as it is stored (unit "1" where there is none).
struct Parameter {
  std::string name;
  double value = 0;
  std::string unit;
  std::string description;
};

/// A key of the scene with its value, in TOML. A list of tables, as that of the pins, has a row for each of its entries.
struct SceneValue {
  std::string key;
  std::string value;
  std::string unit;  ///< "1": a number without dimension; empty: not a number
};

/// How often a kind of work was done.
struct WorkCount {
  std::string name;
  std::string description;
  std::int64_t count = 0;
};

/// One accepted step.
struct StepRecord {
  double t = 0;  ///< [s], at the end of the step
  double h = 0;  ///< [s]
  int updates = 0;
  int cg_iterations = 0;
  double kinetic_energy = 0;    ///< [J]
  double potential_energy = 0;  ///< [J]
  int contacts = 0;             ///< particles constrained by obstacles
};

/// What obstacles did to a run.
struct ContactRecord {
  double clearance = 0;    ///< least distance of a particle from an obstacle at the end of any step [m], negative inside
  double energy_rise = 0;  ///< largest rise of the total energy above what it was before, over the run's energies
  double area = 0;         ///< in contact at the end, over the sheet's
  double reference_area = std::numeric_limits<double>::quiet_NaN();  ///< of the reference, NaN if there is none
};

/// What a particle is in a frame of a trajectory.
enum class Constraint : int { free, pinned, in_contact, no_cloth };

/// The motion of a sheet of `nu` × `nv` particles, F frames of N = nu nv; the particle (a, b) is row a + nu b. Cells have the
/// corners (a, b), (a + 1, b), (a + 1, b + 1), (a, b + 1).
struct TrajectoryRecord {
  int nu = 0, nv = 0;                        ///< particles along u (weft) and v (warp); 1: a chain
  std::vector<std::array<int, 2>> panels;    ///< their nu and nv, if there are several, one after the other; then nv = 1
  std::vector<double> times;                 ///< F, ascending, from the start on [s]
  std::vector<solver::State> states;         ///< F
  std::vector<Eigen::VectorXd> stretch;      ///< F × N: mean strain of the edges that meet in a particle
  std::vector<std::vector<int>> constraint;  ///< F × N: a Constraint
};

/// Why a method and its step were chosen, where the program chose them.
struct ChoiceRecord {
  double accuracy = 0;  ///< the largest error of positions that was asked for, over the size of the scene
  std::string reason;   ///< in a sentence or two, with the numbers that decided
};

/// Distance of the final state from a reference. Lengths are divided by the scene's size, energies by the largest sum of
/// kinetic energy and change of potential energy along the reference, so nothing has a unit. A spread is what a small
/// perturbation of the start does to the quantity.
struct ErrorRecord {
  double rms = 0;
  double maximum = 0;
  std::string reference;           ///< the two solvers, for example "cvode-bdf + arkode-esdirk"
  double reference_tolerance = 0;  ///< relative tolerance they ran with
  double reference_error = 0;      ///< their disagreement, in the same measure as rms
  double growth = 0;               ///< of a small perturbation of the start
  double energy = 0;               ///< difference of the total energy
  double energy_spread = 0;
  double centre = 0;  ///< distance of the centre of mass
  double centre_spread = 0;
};

/// Errors of the whole motion: the largest at the reference's times, which the cubic between two steps gives where none ends.
/// Scales are those of the reference's own motion, at these times, and no less than those of a thousandth of the scene's size a
/// run, so that they are not 0 where nothing moves.
struct MotionErrorRecord {
  double position = 0;            ///< root of the mean squared distance, over the size of the scene, as ErrorRecord::rms
  double amplitude = 0;           ///< the reference's largest distance from its start, in the same measure
  double relative = 0;            ///< the distance over the amplitude
  double velocity = 0;            ///< the same of velocities, over the reference's largest
  double reference_velocity = 0;  ///< disagreement of the reference's two solvers in it
  double energy = 0;              ///< difference of the total energy, over the scale of ErrorRecord::energy
  double momentum = 0;            ///< distance of the momenta, over the mass times the reference's largest velocity
  double angular_momentum = 0;    ///< the same about the centre of the start, over that times the size
};

/// Beyond this growth of a perturbation the final positions say little about a method: compare energies and statistics.
inline constexpr double comparable_growth = 100;

/// So do they beyond this uncertainty of the reference, as where contacts decide which way a sheet folds.
inline constexpr double comparable_error = 1e-2;

inline bool comparable(const ErrorRecord& error) {
  return error.growth <= comparable_growth && error.reference_error <= comparable_error;
}

/// An error below this multiple of its reference's uncertainty is not a number to rely on.
inline constexpr double resolution = 10;
inline bool resolved(const ErrorRecord& error) { return error.rms >= resolution * error.reference_error; }

/// All that is kept of one run: plain data, filled by the run engine, written by the recording.
struct RunRecord {
  std::string cell;  ///< identity of what was run: equal in all files where the same was asked for; empty outside of sweeps
  std::string scene;
  std::string scene_toml;              ///< the complete scene, defaults and overrides included, for users
  std::vector<SceneValue> scene_keys;  ///< the same as data
  std::string overrides;               ///< what was set differently from the scene, for example "material.damping=0.5"
  std::string plan;                    ///< what the scene compiled to, for users
  std::string method;                  ///< as on the command line, for example "bdf2/cholesky"
  std::string stage_solver;
  std::string linear_solver;
  double step = 0;                     ///< [s]
  double until = 0;                    ///< [s]
  std::optional<ChoiceRecord> choice;  ///< if the program chose method and step
  std::vector<Parameter> parameters;
  double numerical_stiffness = 0;   ///< ν_h = h² k / (ρ l²), the larger of weft and warp
  double stiffness_to_damping = 0;  ///< h k / d; infinite without damping

  solver::Outcome outcome = solver::Outcome::success;
  std::string message;
  double last_good_time = 0;  ///< [s]

  std::vector<StepRecord> steps;
  std::vector<double> times_ms;  ///< solver wall time of every repetition, in the order they ran
  std::vector<WorkCount> work;
  solver::State final_state;
  std::optional<ErrorRecord> error;
  std::optional<MotionErrorRecord> motion_error;  ///< absent in files of programs that did not measure it
  std::optional<ContactRecord> contact;           ///< if the scene has obstacles
  std::optional<TrajectoryRecord> trajectory;     ///< if it was asked for

  bool succeeded() const { return outcome == solver::Outcome::success; }
};

/// The count of a kind of work, 0 if the run knows no such kind.
inline std::int64_t work_count(const RunRecord& run, const std::string& name) {
  const auto known = std::ranges::find(run.work, name, &WorkCount::name);
  return known == run.work.end() ? 0 : known->count;
}

}  // namespace drape::results
