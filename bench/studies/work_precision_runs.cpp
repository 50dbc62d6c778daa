#include "bench/studies/work_precision_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>

#include "bench/timing.hpp"
#include "reference/reference.hpp"

namespace drape::bench {
namespace {

using Clock = std::chrono::steady_clock;

/// Below so many uncertainties of the truth an error says nothing.
constexpr double too_exact = 1;

/// A family that is so many times slower than another of the same code twice in a row will not win, unless its steps are so
/// coarse that finer ones take less time.
constexpr double hopeless = 2;

/// Steps may be so coarse that nothing converges in time: this many are left out then, as long as no finer one has succeeded.
constexpr std::size_t leap = 4;

/// A first run may have been so much slower than others by chance.
constexpr double slack = 1.4;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Lets evaluations of the force and its derivatives fail when the time is up.
void limit(solver::SplitOde& ode, double seconds) {
  const auto deadline = Clock::now() + std::chrono::duration<double>(seconds);
  const auto limited = [=](auto inner) {
    return [=](auto&&... arguments) {
      if (Clock::now() > deadline) throw std::runtime_error(fmt::format("longer than {:g} s", seconds));
      inner(arguments...);
    };
  };
  ode.force = limited(ode.force);
  ode.explicit_force = limited(ode.explicit_force);
  ode.jacobian = limited(ode.jacobian);
  ode.newton_matrix = limited(ode.newton_matrix);
}

double largest_error(const Problem& problem, const std::vector<solver::Vectors>& positions) {
  double largest = 0;
  for (std::size_t k = 0; k < problem.truth.size(); ++k)
    largest = std::max(largest, reference::rms_distance(positions.at(k), problem.truth[k]) / problem.length);
  return largest;
}

/// Of our counters and those of SUNDIALS' packages: each run knows some.
std::int64_t count(const solver::Work& work, std::initializer_list<std::string_view> names) {
  std::int64_t sum = 0;
  for (const solver::Work::Kind& kind : work.kinds())
    if (std::ranges::find(names, kind.name) != names.end()) sum += kind.count;
  return sum;
}

void note_work(const solver::Work& work, Trial& trial) {
  trial.forces = count(work, {"forces", "explicit_forces"});
  trial.factorisations = count(
      work, {"newton_factorizations", "factorizations", "cvode/factorisations", "arkode/factorisations", "ida/factorisations"});
  trial.steps = count(work, {"steps", "cvode/steps", "arkode/steps", "ida/steps"});
}

Trial attempt(const Problem& problem, const Family& family, const Candidate& candidate, double cap) {
  Trial trial{&family, &candidate, "success", {std::nan(""), {}}};
  model::Cloth cloth = model::compile(problem.scene);
  limit(cloth.ode, cap);
  try {
    const auto begin = Clock::now();
    const auto positions = candidate.solve(cloth, problem.times);
    const double milliseconds = 1e3 * seconds_since(begin);
    trial.measured = {largest_error(problem, positions), {milliseconds}};
    if (!std::isfinite(trial.measured.error)) throw std::runtime_error("not finite");
  } catch (const std::exception& error) {
    trial.outcome = error.what();
    trial.measured = {std::nan(""), {}};
  }
  note_work(*cloth.ode.work, trial);
  return trial;
}

/// Whether another trial of the same code was as exact in a small part of the time.
bool outdone(const Trial& trial, const std::vector<Trial>& trials) {
  return !trial.measured.times.empty() && std::ranges::any_of(trials, [&](const Trial& other) {
    return other.family->code == trial.family->code && !other.measured.times.empty() &&
           other.measured.error <= trial.measured.error && hopeless * other.measured.times[0] < trial.measured.times[0];
  });
}

void add_family(const Problem& problem, const Family& family, double cap, std::vector<Trial>& trials) {
  int times_outdone = 0;
  double before = INFINITY;  // seconds
  bool succeeded = false;
  for (std::size_t k = 0; k < family.candidates.size();) {
    const auto begin = Clock::now();
    const Trial trial = attempt(problem, family, family.candidates[k], cap);
    const double seconds = seconds_since(begin);
    const bool too_long = seconds > 0.7 * cap;
    succeeded |= trial.outcome == "success";
    times_outdone = seconds > before && outdone(trial, trials) ? times_outdone + 1 : 0;
    before = seconds;
    trials.push_back(trial);
    if ((too_long && succeeded) || trial.measured.error < too_exact * problem.uncertainty || times_outdone > 1) return;
    k += too_long ? leap : 1;
  }
}

}  // namespace

std::vector<double> levels(const Problem& problem) {
  constexpr double part = 0.3;  // of an error that the truth may be uncertain by
  std::vector<double> all;
  for (int digits = 1; digits <= 7; ++digits)
    if (const double error = std::pow(10.0, -digits); problem.uncertainty <= part * error) all.push_back(error);
  return all;
}

std::vector<double> asked(const Problem& problem) {
  std::vector<double> all = levels(problem);
  all.insert(all.end(), problem.asked.begin(), problem.asked.end());
  return all;
}

std::vector<Trial> try_all(const Problem& problem, const std::vector<Family>& families, const Effort& effort, Units& units) {
  std::vector<Trial> trials;
  for (const Family& family : families) {
    units.show(fmt::format("{}: {}", problem.name, family.name));
    add_family(problem, family, effort.cap, trials);
    units.advance();
  }
  return trials;
}

std::vector<Contender> contenders(const std::vector<Trial>& trials) {
  std::vector<Contender> all{{"ours", {}}};
  const auto join = [&](const std::string& name, std::size_t k) {
    for (Contender& contender : all)
      if (contender.name == name) return contender.members.push_back(k);
    all.push_back({name, {k}});
  };
  for (std::size_t k = 0; k < trials.size(); ++k) {
    const Family& family = *trials[k].family;
    if (family.code == "drape" || family.code == "explicit" || family.code == "thesis") join("ours", k);
    if (family.code == "drape" || family.code == "thesis") join("implicit", k);
    if (family.code != "drape") join(family.code, k);
    if (!family.method.empty()) join("defaults", k);
    if (!family.method.empty()) join(fmt::format("default {} by {}", family.method, family.control), k);
  }
  return all;
}

void time_fronts(const Problem& problem, std::vector<Trial>& trials, const Effort& effort) {
  std::set<std::size_t> chosen;
  for (const Contender& contender : contenders(trials)) {
    std::vector<results::Measured> measured;
    for (const std::size_t k : contender.members) measured.push_back(trials[k].measured);
    for (const std::size_t k : results::near_quickest(measured, asked(problem), slack)) chosen.insert(contender.members[k]);
  }
  std::vector<Prepare> runs;
  for (const std::size_t k : chosen)
    runs.emplace_back([&problem, &solve = trials[k].candidate->solve] {
      return [&problem, &solve, cloth = std::make_shared<model::Cloth>(model::compile(problem.scene))] {
        solve(*cloth, problem.times);
      };
    });
  const auto times = time_runs(runs, effort.repetitions, [] {});
  for (std::size_t place = 0; const std::size_t k : chosen) {
    trials[k].measured.times = times[place++];
    trials[k].timed = true;
  }
}

std::vector<results::Measured> timed(const Contender& contender, const std::vector<Trial>& trials) {
  std::vector<results::Measured> measured;
  for (const std::size_t k : contender.members) {
    measured.push_back(trials[k].measured);
    if (!trials[k].timed) measured.back().times.clear();
  }
  return measured;
}

}  // namespace drape::bench
