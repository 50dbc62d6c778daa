#pragma once

#include <tuple>

#include "results/run_record.hpp"

namespace drape::results {

/// The layout of a run in the file: this one list serves writing and reading. results/README.md shows it for users.
inline constexpr int schema_version = 6;
inline constexpr int oldest_readable_version = 4;  ///< see schema_4.hpp and schema_5.hpp

/// A member of a record under its name in the file. Text has no unit; numbers have one, "1" if they have no dimension.
template <class Record, class Value>
struct Field {
  const char* name;
  Value Record::*member;
  const char* unit;
  const char* description;
};
template <class Record, class Value>
Field(const char*, Value Record::*, const char*, const char*) -> Field<Record, Value>;

inline constexpr std::tuple run_fields{
    Field{"cell", &RunRecord::cell, "", "identity of what was run: hash of all that determines the result"},
    Field{"scene", &RunRecord::scene, "", "name of the scene"},
    Field{"scene_toml", &RunRecord::scene_toml, "", "the complete scene, defaults and overrides included, as a scene file"},
    Field{"overrides", &RunRecord::overrides, "", "what was set differently from the scene"},
    Field{"plan", &RunRecord::plan, "", "what the scene compiled to"},
    Field{"method", &RunRecord::method, "", "time integrator with its solvers, as on the command line"},
    Field{"stage_solver", &RunRecord::stage_solver, "", "how the implicit stages were solved"},
    Field{"linear_solver", &RunRecord::linear_solver, "", "how the linear systems were solved"},
    Field{"outcome", &RunRecord::outcome, "", "how the run ended; anything but success means that its result must not be used"},
    Field{"message", &RunRecord::message, "", "why the run failed"},
    Field{"step", &RunRecord::step, "s", "step size h asked for"},
    Field{"until", &RunRecord::until, "s", "end time asked for"},
    Field{"last_good_time", &RunRecord::last_good_time, "s", "time reached without failure"},
    Field{"numerical_stiffness", &RunRecord::numerical_stiffness, "1", "h^2 k / (rho l^2), the larger of weft and warp"},
    Field{"stiffness_to_damping", &RunRecord::stiffness_to_damping, "1", "h k / d; infinite without damping"},
    Field{"times_ms", &RunRecord::times_ms, "ms", "solver wall time of every repetition, in the order they ran"},
};

/// Datasets of `scene_keys`, which is absent in older files of the same version: see schema_4.hpp.
inline constexpr std::tuple scene_key_fields{
    Field{"key", &SceneValue::key, "", "key of scene files; the key of a list of tables stands once for each of them"},
    Field{"value", &SceneValue::value, "", "its value, in TOML"},
    Field{"unit", &SceneValue::unit, "", "of the value; 1: a number without dimension, empty: not a number"},
};

inline constexpr std::tuple choice_fields{
    Field{"accuracy", &ChoiceRecord::accuracy, "1", "largest error of positions that was asked for, over the size"},
    Field{"reason", &ChoiceRecord::reason, "", "why this method with this step"},
};

inline constexpr std::tuple step_fields{
    Field{"t", &StepRecord::t, "s", "time at the end of the step"},
    Field{"h", &StepRecord::h, "s", "size of the step"},
    Field{"updates", &StepRecord::updates, "1", "updates of the iterate by the stage solver"},
    Field{"cg_iterations", &StepRecord::cg_iterations, "1", "iterations of the conjugate gradient method"},
    Field{"kinetic_energy", &StepRecord::kinetic_energy, "J", "kinetic energy at the end of the step"},
    Field{"potential_energy", &StepRecord::potential_energy, "J", "potential energy at the end of the step"},
    Field{"contacts", &StepRecord::contacts, "1", "particles constrained by obstacles"},
};

inline constexpr std::tuple contact_fields{
    Field{"clearance", &ContactRecord::clearance, "m",
          "least distance of a particle from an obstacle at the end of any step, negative inside"},
    Field{"energy_rise", &ContactRecord::energy_rise, "1",
          "largest rise of the total energy above what it was before, over the largest energy of the run"},
    Field{"area", &ContactRecord::area, "1", "area in contact at the end, over that of the sheet"},
    Field{"reference_area", &ContactRecord::reference_area, "1", "the same of the reference; NaN if there is none"},
};

inline constexpr std::tuple state_fields{
    Field{"x", &solver::State::x, "m", "positions, one row for each particle"},
    Field{"v", &solver::State::v, "m/s", "velocities, one row for each particle"},
};

/// Beside these where forces remember the motion.
inline constexpr Field memory_field{"z", &solver::State::z, "1",
                                    "internal variables of forces that remember the motion, in SI units"};

/// Datasets of `trajectory`, with a frame for each of the times t; the states' frames are written under the names of
/// state_fields.
inline constexpr std::tuple trajectory_fields{
    Field{"nu", &TrajectoryRecord::nu, "1", "particles along u, the weft; the particle (a, b) is row a + nu b"},
    Field{"nv", &TrajectoryRecord::nv, "1", "particles along v, the warp"},
    Field{"t", &TrajectoryRecord::times, "s", "time of each frame"},
    Field{"stretch", &TrajectoryRecord::stretch, "1", "mean strain of the edges that meet in a particle"},
    Field{"constraint", &TrajectoryRecord::constraint, "1", "0 free, 1 pinned, 2 in contact"},
};

inline constexpr std::tuple error_fields{
    Field{"rms", &ErrorRecord::rms, "1",
          "root of the mean squared distance to the reference, divided by the size of the scene"},
    Field{"maximum", &ErrorRecord::maximum, "1", "largest distance to the reference, divided by the size of the scene"},
    Field{"reference", &ErrorRecord::reference, "", "the two solvers that make the reference"},
    Field{"reference_tolerance", &ErrorRecord::reference_tolerance, "1", "relative tolerance the reference was computed with"},
    Field{"reference_error", &ErrorRecord::reference_error, "1", "disagreement of the two solvers, in the same measure as rms"},
    Field{"growth", &ErrorRecord::growth, "1", "growth of a small perturbation of the start; rms means little beyond 100"},
    Field{"energy", &ErrorRecord::energy, "1",
          "difference of the total energy, over the largest sum of kinetic energy and change of potential energy"},
    Field{"energy_spread", &ErrorRecord::energy_spread, "1", "what the perturbation does to the energy, in the same measure"},
    Field{"centre", &ErrorRecord::centre, "1", "distance of the centres of mass, divided by the size of the scene"},
    Field{"centre_spread", &ErrorRecord::centre_spread, "1", "what the perturbation does to the centre, in the same measure"},
};

/// Datasets of `motion_error`, which is absent in older files of the same version.
inline constexpr std::tuple motion_error_fields{
    Field{"position", &MotionErrorRecord::position, "1",
          "largest root of the mean squared distance to the reference at any of its times, divided by the size of the scene"},
    Field{"amplitude", &MotionErrorRecord::amplitude, "1",
          "the reference's largest distance from its start, in the same measure"},
    Field{"relative", &MotionErrorRecord::relative, "1", "position over amplitude"},
    Field{"velocity", &MotionErrorRecord::velocity, "1",
          "largest root of the mean squared difference of velocities, over the largest of the reference's velocities"},
    Field{"reference_velocity", &MotionErrorRecord::reference_velocity, "1",
          "disagreement of the two solvers, in the same measure as velocity"},
    Field{"energy", &MotionErrorRecord::energy, "1",
          "largest difference of the total energy, over the largest sum of kinetic energy and change of potential energy"},
    Field{"momentum", &MotionErrorRecord::momentum, "1",
          "largest difference of the momentum, over the mass times the largest of the reference's velocities"},
    Field{
        "angular_momentum", &MotionErrorRecord::angular_momentum, "1",
        "largest difference of the angular momentum about the centre of the start, over the same times the size of the scene"},
};

/// Calls visit(field) for every field of a list.
template <class Fields, class Visit>
void for_each(const Fields& fields, Visit visit) {
  std::apply([&](const auto&... field) { (visit(field), ...); }, fields);
}

}  // namespace drape::results
