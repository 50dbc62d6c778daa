#pragma once

#include <optional>
#include <string>

#include "bench/runs/run.hpp"

namespace drape::bench {

/// Tells runs that are unstable from those that are wrong but bounded, by a balance of energy along the run:
///
///     E(t) − E(0) + ∫ damping ≤ ∫ power given + what is tolerated,     E = kinetic + elastic + gravity's.
///
/// What is given: work of forces without an energy (wind, projected bending, the printed forms), of moving pins and of
/// obstacles. From step to step that is ½ (f0 + f1)·(x1 − x0), exact for linear forces however long the step; the difference
/// from the same sum with double steps is what it is uncertain by. Linear damping takes at least −(x1 − x0)ᵀ D (x1 − x0)/h, all
/// other damping at least 0. A scene in which only gravity gives costs no evaluation of a force.
class EnergyGuard {
 public:
  /// What may come from nowhere, over all that a sheet was given. Semi-implicit methods overshoot by about as much without
  /// being unstable. Given is the energy of the start, the most that gravity and the work above have added to it, and the
  /// uncertainty of that work.
  static constexpr double tolerated = 3;

  /// And what a free fall gives in three steps, or in a quarter of the scene's time if that is less: the first steps of a
  /// method may be wrong by more than the little that was given until then.
  static constexpr double first_steps = 3, first_part = 0.25;

  /// Keeps a reference to the cloth, whose start is the beginning of the run.
  EnergyGuard(const model::Scene& scene, const model::Cloth& cloth);

  /// Follows the run by an accepted step; whether the energy is above its limit now, or no number.
  bool exceeded(const solver::StepReport& step);

  /// What a run that ends at t is told.
  std::string message(double t) const;

  double energy() const { return energy_; }  ///< kinetic and elastic, after the last step [J]
  double limit() const { return limit_; }    ///< of that [J]

  /// False if the work is more uncertain than the tolerance is wide, as it is after a single step: then the limit is wider than
  /// stated.
  bool judges() const { return judges_; }

 private:
  /// The work of model::Cloth::given.
  class GivenWork {
   public:
    /// `jumps`: whether forces are switched on and off within steps, whose work then stays uncertain.
    GivenWork(const solver::SplitOde::Force& given, double begin, const solver::State& start, bool jumps);
    void go_on(double t, const solver::State& y);
    double value() const { return fine_; }
    double doubt() const { return doubt_ + pending_; }

    /// False after a single step: nothing tells what its work is uncertain by.
    bool compared() const { return !given_ || paired_; }

   private:
    /// A state of the run with the force on it.
    struct Point {
      solver::Vectors x, f;
      double work_to(const Point& next) const { return 0.5 * (f + next.f).cwiseProduct(next.x - x).sum(); }
    };
    const solver::SplitOde::Force& given_;
    Point pair_, last_, now_;  ///< the beginning of the pair of steps, and of the step
    bool jumps_, halfway_ = false, paired_ = false;
    double fine_ = 0, coarse_ = 0;    ///< by single and by double steps [J]
    double doubt_ = 0, pending_ = 0;  ///< of all pairs, and of the step that has none yet [J]
  };

  double unresolved(const solver::StepReport& step, const solver::Vectors& moved) const;
  double kinetic_and_elastic(double t, const solver::State& y) const;

  const model::Cloth& cloth_;
  model::Wind wind_;
  Eigen::VectorXd areas_;   ///< [m²]
  solver::Vectors weight_;  ///< [N]
  solver::Vectors x_;       ///< after the last step
  double start_, noise_;    ///< [J]
  double fall_, time_;      ///< [J/s²], of the whole run [s]
  double most_given_;       ///< [J]
  double damped_ = 0, contact_work_ = 0, unresolved_ = 0, energy_ = 0, limit_ = 0;
  GivenWork work_;
  bool judges_ = true;
};

/// Ends a run whose energy exceeds the guard's limit, or is not a number, as `unstable`; its last good time is that of the step
/// before. Where the guard cannot judge, it says so.
class EnergyGuardObserver : public Observer {
 public:
  void begin(const model::Scene& scene, const model::Cloth& cloth, const solver::State&) override {
    guard_.emplace(scene, cloth);
    good_ = cloth.begin;
  }
  void observe(const solver::StepReport& step) override;
  std::string remark() const override;

  const EnergyGuard& guard() const { return *guard_; }  ///< of a run that has begun

 private:
  std::optional<EnergyGuard> guard_;
  double good_ = 0;  ///< [s]
};

/// A run under the energy guard alone.
RunEnd run_guarded(const RunSpec& spec, const model::Cloth& cloth, const Limits& limits);

}  // namespace drape::bench
