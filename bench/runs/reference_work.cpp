#include "bench/runs/reference_work.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <mutex>

#include "bench/runs/interruption.hpp"
#include "bench/runs/limits.hpp"

namespace drape::bench {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// The motions that one thread computes, one after the other.
struct Course {
  int motions;  ///< in all, at least
  int begun = 0;
  double t = 0;  ///< [s] of the motion it is at
  Clock::time_point begin = {};

  /// Seconds of wall time that are left; not a number as long as that cannot be told.
  double left(Clock::time_point now, double end) const {
    const double elapsed = Seconds(now - begin).count(), pace = t > 0.02 * end ? elapsed / t : std::nan("");
    return pace * (end - t) + std::max(0, motions - begun) * pace * end;
  }
};

/// Learns from the forces how far a reference has come, on both threads.
class Pace {
 public:
  Pace(double end, const std::function<void(const std::string&)>& say)
      : end_(end), say_(say), courses_{{{reference::first_motions}, {1}}} {}

  /// `ode`: that of the trajectory or of the witness. It must not outlive this object.
  void watch(solver::SplitOde& ode, std::size_t course) {
    if (!say_) return;
    for (auto* part : {&ode.force, &ode.explicit_force})
      *part = [=, this, force = *part](double t, const solver::Vectors& x, const solver::Vectors& v, solver::Vectors& f) {
        see(courses_[course], t);
        force(t, x, v, f);
      };
  }

 private:
  void see(Course& course, double t) {
    const std::scoped_lock lock(mutex_);
    const auto now = Clock::now();
    if (course.begun == 0 || (t == 0 && course.t > 0)) {
      ++course.begun;
      course.begin = now;
    }
    course.t = t;
    if (now < next_) return;
    next_ = now + std::chrono::milliseconds(200);
    say_(line(now));
  }

  std::string line(Clock::time_point now) const {
    const auto& [first, second] = courses_;
    const double left = std::max(first.left(now, end_), second.left(now, end_));
    const bool known = !std::isnan(first.left(now, end_)) && !std::isnan(second.left(now, end_));
    const std::string motion = first.begun <= 1 ? "trajectory" : fmt::format("motion {} of its conditioning", first.begun - 1);
    return fmt::format("{} at t = {:.3f} s, witness at t = {:.3f} s of {:g} s, {}", motion, first.t, second.t, end_,
                       known ? fmt::format("some {:.0f} s left", left) : "estimating");
  }

  const double end_;
  const std::function<void(const std::string&)>& say_;
  std::mutex mutex_;
  std::array<Course, 2> courses_;
  Clock::time_point next_ = Clock::now() + std::chrono::seconds(3);
};

}  // namespace

reference::Reference compute_reference(const model::Scene& scene, const model::Cloth& cloth, const std::vector<double>& times,
                                       const reference::SolveOptions& options, const ReferenceWatch& limits, double seconds) {
  const model::Cloth twin = model::compile(scene);
  solver::SplitOde first = cloth.ode, second = twin.ode;
  Pace pace(times.back(), limits.say);
  const Limits own{.seconds = seconds};
  std::array<Meter, 2> meters{Meter(own), Meter(own)};
  for (const auto& [ode, course] : {std::pair(&first, 0), std::pair(&second, 1)}) {
    pace.watch(*ode, course);
    meters.at(static_cast<std::size_t>(course)).watch(*ode);
  }
  const reference::Equations equations{first, second};
  try {
    return first.has_contacts() ? reference::contact_reference(equations, cloth.start, 0, times, options)
                                : reference::reference(equations, cloth.start, 0, times, options);
  } catch (const LimitReached&) {  // of our own methods; solvers of SUNDIALS make it an error of theirs
  } catch (const reference::ReferenceError&) {
    check_interruption();  // it may have been the reason
    if (!meters[0].reached() && !meters[1].reached()) throw;
  }
  throw reference::ReferenceError(fmt::format("out of time: longer than {:g} s", limits.seconds), "OUT_OF_TIME", 0);
}

}  // namespace drape::bench
