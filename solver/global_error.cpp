#include "solver/global_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "solver/dense_output.hpp"

namespace drape::solver {
namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();

constexpr double aim = 0.7;          ///< part of the tolerance that the error should be
constexpr double lowest = 0.25;      ///< and may be
constexpr double crudest = 0.1;      ///< tolerance of the local error of the first pilot, at most,
constexpr double head_start = 1e3;   ///< and over the tolerance
constexpr double converging = 2.5;   ///< least factor by which their distances fall
constexpr double most_ahead = 10;    ///< error of the last pilot over that of the run
constexpr double negligible = 0.05;  ///< distance over the tolerance that need not fall that far,
constexpr double steady = 0.5;       ///< but hardly rise
constexpr double apart = 1.5;        ///< least quotient of errors that a distance tells from each other,
constexpr double further = 2;        ///< and of those of a further pilot
constexpr double narrow = 1.1;       ///< quotient of scales with nothing worth a pilot between them
constexpr int most_pilots = 20;
constexpr int most_trial_pilots = 6;
constexpr int many_steps = 50;     ///< fewer are nothing to remark on
constexpr int few_steps = 10'000;  ///< that any pilot may take,
constexpr double most_excess = 4;  ///< or as many times more than expected

struct Pilot {
  double scale;  ///< of steps
  int steps = 0;
  bool largest_steps = false;           ///< whether all are as long as allowed
  std::vector<Vectors> positions = {};  ///< at the tenths; fewer if it failed
  std::string message = {};             ///< why it did
  double distance = unknown;            ///< from the one flown before
  double error = unknown;
};

/// Counters that pilots do not add to.
class OwnSteps {
 public:
  explicit OwnSteps(Counters& work)
      : pilots_(work.counter("pilot_steps", "steps of runs that measured the error, accepted or not")) {
    for (const char* name : {"steps", "rejected_steps", "starting_steps"}) counters_.push_back(&work.counter(name, ""));
    for (const std::int64_t* counter : counters_) before_.push_back(*counter);
  }
  OwnSteps(const OwnSteps&) = delete;
  OwnSteps& operator=(const OwnSteps&) = delete;

  ~OwnSteps() {
    for (std::size_t k = 0; k < counters_.size(); ++k) {
      if (k < 2) pilots_ += *counters_[k] - before_[k];
      *counters_[k] = before_[k];
    }
  }

 private:
  std::int64_t& pilots_;
  std::vector<std::int64_t*> counters_;
  std::vector<std::int64_t> before_;
};

class Planner {
 public:
  Planner(const Integrator& integrator, double t_end, double h)
      : integrator_(integrator), control_(integrator.options().error_control), t_end_(t_end), h_(h) {
    coarsest_ = std::min(crudest, head_start * control_.tolerance);
    for (int k = 1; k <= 10; ++k) times_.push_back(integrator.time() + 0.1 * k * (t_end - integrator.time()));
  }

  GlobalControl plan() {
    while (!enough()) {
      const double scale = pilots_.empty() ? 1 : pilots_.back().scale * std::pow(refinement(), -1.0 / order());
      if (std::ssize(pilots_) == most_pilots || !fly(scale)) return too_costly(scale);
    }
    remark_ = remark();
    exponent_ = std::log(rate()) / std::log(refinement()) * order();
    measure();
    for (int trials = 0;; ++trials) {
      const double scale = wanted_scale();
      const auto same = std::ranges::find(pilots_, scale, &Pilot::scale);
      if (same != pilots_.end()) return {tolerance(scale), largest_step(scale), true, remark_.empty() ? cliff(*same) : remark_};
      if (trials == most_trial_pilots || !fly(scale)) return too_costly(scale);
      std::ranges::sort(pilots_, std::greater(), &Pilot::scale);
      measure();
    }
  }

 private:
  int order() const { return integrator_.method().order; }
  /// Factor by which the error should fall from pilot to pilot; no more than by steps of a quarter.
  double refinement() const { return std::min(10.0, std::pow(4.0, order())); }

  double target() const { return aim * control_.tolerance; }
  double tolerance(double scale) const { return coarsest_ * std::pow(scale, order() + 1); }
  double largest_step(double scale) const { return h_ * std::min(1.0, scale); }

  /// Runs with steps of this scale; false if it takes too many.
  bool fly(double scale) {
    const double expected = expected_steps(scale);
    if (expected > control_.most_steps) return false;
    Options options = integrator_.options();
    options.error_control.global = false;
    options.error_control.tolerance = tolerance(scale);
    if (!pilots_.empty())
      options.error_control.most_steps =
          static_cast<int>(std::min<double>(control_.most_steps, std::max<double>(few_steps, most_excess * expected)));
    Integrator integrator(integrator_.ode(), integrator_.method(), options, integrator_.state(), integrator_.time());
    SmoothOutput output(times_, integrator.time(), integrator.state());
    const RunResult run =
        integrate(integrator, t_end_, largest_step(scale), [&](const StepReport& step) { output.observe(step.t, step.y); });
    const int steps = run.steps + run.rejected_steps;
    const bool largest = steps <= std::ceil((t_end_ - integrator_.time()) / largest_step(scale));
    pilots_.push_back({scale, steps, largest, std::move(output.positions), run.message});
    if (pilots_.size() > 1) pilots_.back().distance = distance(pilots_[pilots_.size() - 2], pilots_.back());
    return steps < options.error_control.most_steps;
  }

  /// The assumed error of the first pilot.
  double distance(const Pilot& a, const Pilot& b) const {
    if (a.positions.size() < times_.size() || b.positions.size() < times_.size()) return unknown;
    double largest = 0;
    for (std::size_t k = 0; k < times_.size(); ++k) largest = std::max(largest, (a.positions[k] - b.positions[k]).norm());
    const double distance = largest / (control_.length * std::sqrt(integrator_.ode().particles()));
    return std::isfinite(distance) ? distance : unknown;
  }

  /// The next pilot, before there are trials.
  double last_distance() const { return pilots_.back().distance; }
  double fall() const { return pilots_[pilots_.size() - 2].distance / last_distance(); }

  /// Ratio of the scales of pilots k − 1 and k, and of their numbers of steps.
  double finer(std::size_t k) const { return pilots_[k - 1].scale / pilots_[k].scale; }
  double more_steps(std::size_t k) const { return static_cast<double>(pilots_[k].steps) / std::max(1, pilots_[k - 1].steps); }

  /// Whether pilot k took steps about as long as the one before, so that their distance does not measure an error.
  bool no_finer(std::size_t k) const { return pilots_[k].steps >= many_steps && more_steps(k) < std::sqrt(finer(k)); }

  /// Whether pilots converge: runs with the same error are near each other, but do not converge.
  bool enough() const {
    if (pilots_.size() < 3 || !std::isfinite(last_distance()) || no_finer(pilots_.size() - 1)) return false;
    const bool small = last_distance() <= negligible * control_.tolerance;
    const bool converge = last_distance() == 0 || fall() >= (small ? steady : converging);
    return converge && last_distance() / (rate() - 1) <= (remark().empty() ? most_ahead : 1) * target();
  }

  /// Factor by which errors fall from pilot to pilot.
  double rate() const { return std::clamp(fall(), std::pow(refinement(), 0.9), std::pow(refinement(), 1.1)); }

  /// Estimates the errors: the finest pilot's from its distance to a coarser one, as errors go with a power of the scale, and
  /// the others' from their distances to the finest.
  void measure() {
    Pilot& finest = pilots_.back();
    finest.error = unknown;
    for (std::size_t k = pilots_.size() - 1; k-- > 0 && finest.error == unknown;) {
      const double taken = static_cast<double>(finest.steps) / std::max(1, pilots_[k].steps);
      const double finer = remark_.empty() ? taken : std::min(taken, pilots_[k].scale / finest.scale);
      const double quotient = std::pow(finer, exponent_);
      if (quotient >= apart) finest.error = distance(pilots_[k], finest) / (quotient - 1);
    }
    for (std::size_t k = 0; k + 1 < pilots_.size(); ++k) pilots_[k].error = distance(pilots_[k], finest) + finest.error;
  }

  /// Scale of the first pilot from which on errors are small enough, or one between it and the one before, or beyond the ends,
  /// that should come nearer to the tolerance.
  double wanted_scale() const {
    std::size_t k = pilots_.size();
    while (k > 0 && pilots_[k - 1].error <= control_.tolerance) --k;
    if (k == pilots_.size())
      return pilots_[k - 1].scale * std::pow(std::clamp(pilots_[k - 1].error / target(), further, 100.0), -1 / exponent_);
    const Pilot& good = pilots_[k];
    if (good.error >= lowest * control_.tolerance) return good.scale;
    const double excess = target() / std::max(good.error, 1e-300);
    if (k == 0) return good.largest_steps ? good.scale : good.scale * std::pow(std::min(excess, 100.0), 1 / exponent_);
    const Pilot& bad = pilots_[k - 1];
    const double scales = bad.scale / good.scale;
    if (scales < narrow) return good.scale;
    const double part = std::log(excess) / std::log(bad.error / std::max(good.error, 1e-300));
    return good.scale * std::pow(scales, std::clamp(std::isfinite(part) ? part : 0.5, 0.1, 0.9));
  }

  double expected_steps(double scale) const {
    return pilots_.empty() ? 0 : pilots_.back().steps * std::max(1.0, pilots_.back().scale / scale);
  }

  GlobalControl too_costly(double scale) const {
    std::string why = fmt::format("an error of {:.2g} takes more than {} steps, about {:.2g} as far as pilot runs tell",
                                  control_.tolerance, control_.most_steps, expected_steps(scale));
    if (!pilots_.back().message.empty()) why += "; the last: " + pilots_.back().message;
    return {0, 0, false, why};
  }

  /// Where the number of steps does not go with their scale, it is not accuracy that determines them, and errors between pilots
  /// cannot be predicted.
  std::string remark() const {
    for (std::size_t k = 1; k < pilots_.size(); ++k) {
      const bool far_more = pilots_[k].steps >= many_steps && more_steps(k) > 2 * finer(k);
      if (!no_finer(k) && !far_more) continue;
      return fmt::format(
          "stability or ringing limits the steps, not the tolerance alone: {}, and {} with steps meant to be {:.2g} times "
          "finer",
          pilots_[k - 1].steps, pilots_[k].steps, finer(k));
    }
    return "";
  }

  /// The remark on a run that is far more accurate than its tolerance.
  std::string cliff(const Pilot& chosen) const {
    if (chosen.error >= lowest * control_.tolerance || chosen.largest_steps || &chosen == pilots_.data()) return "";
    const Pilot& coarser = *(&chosen - 1);
    return fmt::format("the error jumps: {:.2g} with {} steps, {:.2g} with {}", coarser.error, coarser.steps, chosen.error,
                       chosen.steps);
  }

  const Integrator& integrator_;
  const ErrorControl& control_;
  double t_end_, h_, coarsest_;
  double exponent_ = 0;  ///< of the scale, with which errors go
  std::vector<double> times_;
  std::vector<Pilot> pilots_;  ///< from coarse to fine
  std::string remark_;
};

}  // namespace

GlobalControl plan_global_control(const Integrator& integrator, double t_end, double h) {
  const OwnSteps own(*integrator.ode().work);
  return Planner(integrator, t_end, h).plan();
}

}  // namespace drape::solver
