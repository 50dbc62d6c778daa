#pragma once

#include <any>
#include <functional>
#include <optional>
#include <string>

#include "solver/contact/separation.hpp"
#include "solver/methods.hpp"

namespace drape::solver {

/// Contacts of one step.
struct ContactReport {
  int constrained = 0;                                ///< number of particles that touched an obstacle
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();  ///< given to the particles, also by StepForces [N s]
  double work = 0;                                    ///< done on the particles by these impulses [J]
};

/// How the motion begins. After a jump, as where seams have merged particles or pins change their velocity, strains and
/// velocities may jump from particle to particle: methods with history then begin with a step that damps, as after a hard
/// impact.
enum class Start { smooth, jump };

/// Advances one ODE by one method. A step that fails leaves time and state as they were.
class Integrator {
 public:
  /// Allocates the memory of all steps. Prescribed velocities are set in the initial state.
  Integrator(const SplitOde& ode, const Method& method, const Options& options, State y0, double t0 = 0,
             Start start = Start::smooth);
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  /// One step of size h > 0, or of less if it ends at a kink; methods with history take the steps before into account.
  /// `inaccurate` if the options limit the error and its estimate is too large.
  StageResult step(double h);

  /// The size of the last step that was accepted [s].
  double last_step() const { return step_.h; }

  /// Estimated error of the last step, accepted or not, over its tolerance; 0 if that is not limited or not known yet.
  double error() const { return error_; }

  /// A careful first step for error control [s].
  double first_step() const;

  const Method& method() const { return method_; }

  double time() const { return history_[0].t; }
  const State& state() const { return history_[0].y; }
  const Options& options() const { return options_; }
  const SplitOde& ode() const { return step_.ode; }

  /// Replaces the options' tolerance of the local error.
  void limit_error(double tolerance) { tolerance_ = tolerance; }

  /// Contacts of the last step.
  ContactReport contacts() const;

 private:
  bool attempt(double h);
  double part_to_kink(double least) const;
  bool end_behind_kink(double part);
  bool attempt_again(double h);
  void follow_stiffness();
  void follow_step_forces();
  void renew_matrices();
  Eigen::Vector3d step_force(StepForces::Part part, double t, const State& y);
  void sum_step_forces();
  void begin_contacts(double h);
  bool hit_hard() const;
  bool relocate();
  void step_without_history();
  void separate();
  void finish_contacts();
  void predict(double h);
  double estimate_error(double h);
  void remember(double h, bool restart);
  double end_of_step(double h);

  const Options options_;
  const Method& method_;
  std::optional<SplitOde> own_;              ///< with the K and D of now, if they change
  std::optional<ContactResponse> contacts_;  ///< of implicit methods
  std::optional<ImpactResponse> impacts_;    ///< of explicit ones
  std::optional<Separation> separation_;     ///< if the cloth meets itself
  std::optional<StageSolver> stage_;
  std::optional<LinearisedSystem> linearised_;
  std::optional<PhiFunctions> phi_;
  History history_;
  Point next_;
  Scratch scratch_;
  SubStepping sub_stepping_;
  StepError step_error_;
  std::any kept_;
  State found_;                                          ///< the end of the step before a response changes it
  ContactReport relocated_;                              ///< what that did
  Eigen::Vector3d separated_ = Eigen::Vector3d::Zero();  ///< impulse of obstacles under pairs that were pushed apart [N s]
  Eigen::Vector3d forced_ = Eigen::Vector3d::Zero();     ///< impulse of obstacles by forces of the step [N s]
  Step step_;
  const bool extrapolates_;  ///< whether the history is longer than the method needs
  double tolerance_;
  double error_ = 0;
  std::int64_t stiffness_changes_ = 0, force_changes_ = 0;
  double lost_time_ = 0;  ///< round-off added to the time [s]
  std::int64_t &steps_, &rejected_, &starting_, &kinks_;
};

/// An accepted step, for observers.
struct StepReport {
  double t;  ///< [s], at its end
  double h;  ///< [s]
  int updates;
  int cg_iterations;
  const State& y;
  ContactReport contacts;
};
using Observer = std::function<void(const StepReport&)>;

/// How a run ended.
struct RunResult {
  Outcome outcome = Outcome::success;
  std::string message;        ///< why it did not reach its end, or what limited its steps; empty otherwise
  double last_good_time = 0;  ///< [s]
  int steps = 0;
  int rejected_steps = 0;
};

/// Runs to t_end with steps of h, the last one clipped. With step control a failing step is cut and tried again, and h
/// follows the number of updates; without, the run ends where a step fails. With control of the global error pilot runs come
/// first. Throws std::invalid_argument unless h > 0.
RunResult integrate(Integrator& integrator, double t_end, double h, const Observer& observer = {});

}  // namespace drape::solver
