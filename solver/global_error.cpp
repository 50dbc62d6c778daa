#include "solver/global_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <vector>

#include "solver/dense_output.hpp"

namespace drape::solver {
namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();

constexpr double aim = 0.7;          ///< part of the tolerance that the error should be
constexpr double crudest = 0.1;      ///< tolerance of the local error of the first pilot, at most,
constexpr double head_start = 1e3;   ///< and over the tolerance
constexpr double converging = 2.5;   ///< least factor by which their distances fall
constexpr double most_ahead = 10;    ///< error of the last pilot over that of the run
constexpr double negligible = 0.05;  ///< distance over the tolerance that need not fall so much,
constexpr double steady = 0.5;       ///< but hardly rise
constexpr int most_pilots = 20;
constexpr int many_steps = 50;  ///< fewer are nothing to remark on

struct Pilot {
  double scale;  ///< of steps
  int steps = 0;
  std::vector<Vectors> positions = {};  ///< at the tenths; fewer if it failed
};

/// Counters that are those of the run itself.
class OwnSteps {
 public:
  explicit OwnSteps(Work& work)
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
      if (std::ssize(pilots_) == most_pilots || expected_steps(scale) > control_.most_steps) return too_costly(scale);
      fly(scale);
    }
    const double scale = wanted_scale();
    if (expected_steps(scale) > control_.most_steps) return too_costly(scale);
    return {tolerance(scale), largest_step(scale), true, std::max(50, static_cast<int>(expected_steps(scale))), remark()};
  }

 private:
  int order() const { return integrator_.method().order; }
  /// Factor by which the error should fall from pilot to pilot; no more than by steps of a quarter.
  double refinement() const { return std::min(10.0, std::pow(4.0, order())); }

  double target() const { return aim * control_.tolerance; }
  double tolerance(double scale) const { return coarsest_ * std::pow(scale, order() + 1); }
  double largest_step(double scale) const { return h_ * std::min(1.0, scale); }

  void fly(double scale) {
    Options options = integrator_.options();
    options.error_control.global = false;
    options.error_control.tolerance = tolerance(scale);
    Integrator integrator(integrator_.ode(), integrator_.method(), options, integrator_.state(), integrator_.time());
    SmoothOutput output(times_, integrator.time(), integrator.state());
    const RunResult run =
        integrate(integrator, t_end_, largest_step(scale), [&](const StepReport& step) { output.see(step.t, step.y); });
    pilots_.push_back({scale, run.steps + run.rejected_steps, std::move(output.positions)});
    if (pilots_.size() > 1) distances_.push_back(distance(pilots_[pilots_.size() - 2], pilots_.back()));
  }

  /// What the error of the first is taken for.
  double distance(const Pilot& a, const Pilot& b) const {
    if (a.positions.size() < times_.size() || b.positions.size() < times_.size()) return unknown;
    double largest = 0;
    for (std::size_t k = 0; k < times_.size(); ++k) largest = std::max(largest, (a.positions[k] - b.positions[k]).norm());
    const double distance = largest / (control_.length * std::sqrt(integrator_.ode().particles()));
    return std::isfinite(distance) ? distance : unknown;
  }

  double last_distance() const { return distances_.back(); }
  double fall() const { return distances_[distances_.size() - 2] / last_distance(); }

  /// How many times finer pilot k was meant to be than the one before, and how many times as many steps it took.
  double finer(std::size_t k) const { return pilots_[k - 1].scale / pilots_[k].scale; }
  double more_steps(std::size_t k) const { return static_cast<double>(pilots_[k].steps) / std::max(1, pilots_[k - 1].steps); }

  /// Whether pilot k took steps about as long as the one before, so that their distance does not measure an error.
  bool no_finer(std::size_t k) const { return pilots_[k].steps >= many_steps && more_steps(k) < std::sqrt(finer(k)); }

  /// Runs that are wrong in the same way are near each other, but they do not converge.
  bool enough() const {
    if (pilots_.size() < 3 || !std::isfinite(last_distance()) || no_finer(pilots_.size() - 1)) return false;
    const bool small = last_distance() <= negligible * control_.tolerance;
    const bool converge = last_distance() == 0 || fall() >= (small ? steady : converging);
    return converge && last_error() <= (remark().empty() ? most_ahead : 1) * target();
  }

  /// Factor by which errors fall from pilot to pilot.
  double rate() const { return std::clamp(fall(), std::pow(refinement(), 0.8), std::pow(refinement(), 1.1)); }

  double last_error() const { return last_distance() / (rate() - 1); }

  /// The error of pilot k, by its way to the last one.
  double error(std::size_t k) const {
    return std::accumulate(distances_.begin() + static_cast<std::ptrdiff_t>(k), distances_.end(), last_error());
  }

  /// Between the last pilot whose error is too large and the next, or beyond the ends.
  double wanted_scale() const {
    std::size_t k = pilots_.size();
    while (k > 0 && error(k - 1) < target()) --k;
    if (k == 0) return between(0, std::max(target() / std::max(error(0), 1e-300), 1e-2), refinement());
    const double excess = error(k - 1) / target();
    if (k == pilots_.size()) return between(k - 1, 1 / excess, rate());
    if (!std::isfinite(excess) || !remark().empty()) return pilots_[k].scale;
    return between(k - 1, 1 / excess, std::clamp(error(k - 1) / error(k), 2.0, 1e3));
  }

  /// From pilot k on, so that the error changes by a factor where one pilot more divides it by `fall`.
  double between(std::size_t k, double factor, double fall) const {
    const double pilots = std::clamp(std::log(factor) / std::log(fall), -8.0, 2.0);
    return pilots_[k].scale * std::pow(refinement(), pilots / order());
  }

  double expected_steps(double scale) const {
    return pilots_.empty() ? 0 : pilots_.back().steps * std::max(1.0, pilots_.back().scale / scale);
  }

  GlobalControl too_costly(double scale) const {
    return {0, 0, false, 0,
            "an error of " + text(control_.tolerance) + " takes more than " + text(control_.most_steps) + " steps, about " +
                text(expected_steps(scale)) + " as far as pilot runs tell"};
  }

  /// Where the number of steps does not go with their scale, it is not accuracy that they serve, and between pilots nothing is
  /// certain.
  std::string remark() const {
    for (std::size_t k = 1; k < pilots_.size(); ++k) {
      const bool far_more = pilots_[k].steps >= many_steps && more_steps(k) > 2 * finer(k);
      if (!no_finer(k) && !far_more) continue;
      return "stability or ringing limits the steps, not the tolerance alone: " + std::to_string(pilots_[k - 1].steps) +
             ", and " + std::to_string(pilots_[k].steps) + " with steps meant to be " + text(finer(k)) + " times finer";
    }
    return "";
  }

  static std::string text(double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.2g", value);
    return digits;
  }

  const Integrator& integrator_;
  const ErrorControl& control_;
  double t_end_, h_, coarsest_;
  std::vector<double> times_;
  std::vector<Pilot> pilots_;
  std::vector<double> distances_;  ///< of each pilot from the next, over the length
};

}  // namespace

GlobalControl plan_global_control(const Integrator& integrator, double t_end, double h) {
  const OwnSteps own(*integrator.ode().work);
  return Planner(integrator, t_end, h).plan();
}

}  // namespace drape::solver
