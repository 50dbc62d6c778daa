#pragma once

#include <span>
#include <vector>

#include "solver/split_ode.hpp"

namespace drape::solver {

/// Contacts within one step of an explicit method: since there is no matrix, each particle is treated alone, by inelastic
/// impulses with Coulomb friction in every sub-step. Shares no code with ContactResponse, so that each can verify the other.
class ImpactResponse {
 public:
  explicit ImpactResponse(const SplitOde& ode);

  /// Finds the possible contacts of the step from t0 to t0 + h.
  void begin(double t0, double h, const State& y0);

  bool empty() const { return contacts_.empty(); }

  /// All contacts of the step, in which particles may take part.
  std::span<const Contact> possible() const { return found_; }

  /// Moves particles that have left their half-spaces to the border as it is s seconds after t0 ...
  void push_out(double s, Vectors& x);

  /// ... and gives these the velocity after the impact, and subtracts the obstacle's reaction from their accelerations for the
  /// next half of a sub-step τ. `begins`: before the first sub-step.
  void stop(double tau, bool begins, Vectors& v, Vectors& a);

  int constrained() const;                              ///< particles that touched something in the last sub-step
  Eigen::Vector3d impulse() const { return impulse_; }  ///< that the obstacles gave to the particles in the step [N s]
  double work() const { return work_; }                 ///< of these impulses [J]

 private:
  /// A contact of a particle with its pins.
  struct Side {
    Contact contact;
    Eigen::Matrix3d allowed;  ///< projector on what the pins leave
    Eigen::Vector3d escape;   ///< displacement that raises <x, n> by 1
    double start;             ///< least <x, n> at the beginning of the step [m]
    bool touched = false;
    double pushed = 0, impact = 0, load = 0;  ///< along `escape`: position [m], velocity [m/s], acceleration [m/s²]
  };

  template <class Missing, class Note>
  void take_turns(double Side::*given, double noise, Vectors& rows, const Missing& missing, const Note& note);
  double largest(const Vectors& rows) const;
  void give(int particle, const Eigen::Vector3d& change, const Eigen::Vector3d& v);

  /// Changes by friction.
  struct Friction {
    Eigen::Vector3d velocity, acceleration;
  };
  static Friction friction(const Side& side, double tau, const Eigen::Vector3d& v, const Eigen::Vector3d& a);

  const SplitOde& ode_;
  double h_ = 0;
  std::vector<Eigen::Matrix3d> allowed_;  ///< for each particle, if there are pins
  std::vector<Contact> found_;
  std::vector<Side> contacts_;
  Eigen::Vector3d impulse_ = Eigen::Vector3d::Zero();
  double work_ = 0;
};

}  // namespace drape::solver
