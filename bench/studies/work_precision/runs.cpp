#include "bench/studies/work_precision/runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <stdexcept>

#include "bench/runs/limits.hpp"
#include "bench/runs/timing.hpp"
#include "reference/reference.hpp"
#include "solver/base/largest.hpp"

namespace drape::bench {
namespace {

/// Below this multiple of the truth's uncertainty an error says nothing.
constexpr double too_exact = 1;

/// A family that is slower by this factor than another of the same code twice in a row will not win, unless finer steps take
/// hardly more time: it may be the quickest at smaller errors, if it is not yet slower by far, or so coarse that nothing
/// follows.
constexpr double hopeless = 2, by_far = 8;
constexpr double hardly_more = 1.3, coarse_error = 1e-2;

/// Steps may be so coarse that nothing converges in time: this many are left out then, as long as no finer one has succeeded.
constexpr std::size_t leap = 4;

/// Runs that take longer [ms] are repeated so often: the fewest times that still show a spread.
constexpr double slow = 100;
constexpr int fewest_repetitions = 3;

/// A first run may have been slower than others by this factor by chance.
constexpr double slack = 1.4;

double seconds(TimeOf time_of) {
  timespec now{};
  clock_gettime(time_of == TimeOf::wall ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Of our counters and those of SUNDIALS' packages: each run knows some.
std::int64_t count(const solver::Counters& work, std::initializer_list<std::string_view> names) {
  std::int64_t sum = 0;
  for (const solver::Counters::Kind& kind : work.kinds())
    if (std::ranges::find(names, kind.name) != names.end()) sum += kind.count;
  return sum;
}

void note_work(const solver::Counters& work, Trial& trial) {
  trial.forces = count(work, {"forces", "explicit_forces"});
  trial.factorisations = count(
      work, {"newton_factorisations", "factorisations", "cvode/factorisations", "arkode/factorisations", "ida/factorisations"});
  trial.steps = count(work, {"steps", "cvode/steps", "arkode/steps", "ida/steps"});
}

Trial try_candidate(const Problem& problem, const Family& family, std::size_t candidate, const Effort& effort) {
  check_interruption();  // SUNDIALS' failure of the one before may have been one
  Trial trial{.family = &family, .candidate = candidate};
  model::Cloth cloth = model::compile(problem.scene);
  Meter meter({.seconds = effort.cap});
  meter.watch(cloth.ode);
  try {
    const double begin = seconds(effort.time_of);
    const auto positions = trial.configuration().solve(cloth, problem.times);
    const double milliseconds = 1e3 * (seconds(effort.time_of) - begin);
    trial.measured = {reference::largest_rms_distance(positions, problem.truth) / problem.length, {milliseconds}};
    if (!std::isfinite(trial.measured.error)) throw std::runtime_error("not finite");
  } catch (const std::exception& error) {
    trial.outcome = error.what();
    trial.measured = {std::nan(""), {}};
  }
  note_work(*cloth.ode.work, trial);
  const std::int64_t starting = count(*cloth.ode.work, {"starting_steps"});
  if (trial.outcome == "success" && 2 * starting > trial.steps) {
    trial.outcome = fmt::format("{} of {} steps are another method's, which starts it", starting, trial.steps);
    trial.measured = {std::nan(""), {}};
  }
  return trial;
}

/// Whether a rival was as exact and quicker by this factor.
bool outdone(const results::Measured& trial, const std::vector<results::Measured>& rivals, double factor) {
  return !trial.times.empty() && std::ranges::any_of(rivals, [&](const results::Measured& other) {
    return !other.times.empty() && other.error <= trial.error && factor * other.times[0] < trial.times[0];
  });
}

/// `rivals`: other trials of the same code.
std::vector<Trial> try_family(const Problem& problem, const Family& family, const Effort& effort,
                              std::vector<results::Measured> rivals) {
  std::vector<Trial> trials;
  int times_outdone = 0;
  double before = INFINITY;
  bool succeeded = false;
  for (std::size_t k = 0; k < family.candidates.size();) {
    const double begin = seconds(effort.time_of);
    const Trial& trial = trials.emplace_back(try_candidate(problem, family, k, effort));
    const double taken = seconds(effort.time_of) - begin;
    const bool too_long = taken > 0.7 * effort.cap;
    succeeded |= trial.outcome == "success";
    const bool slower = taken > hardly_more * before;
    const bool lost = !family.advised && (slower || trial.measured.error <= coarse_error) &&
                      outdone(trial.measured, rivals, slower ? hopeless : by_far);
    times_outdone = lost ? times_outdone + 1 : 0;
    before = taken;
    rivals.push_back(trial.measured);
    const bool exact = trial.measured.error < std::max(too_exact * problem.uncertainty, problem.enough);
    if ((too_long && succeeded) || exact || times_outdone > 1) break;
    k += too_long ? leap : 1;
  }
  return trials;
}

std::vector<results::Measured> rivals_of(const Family& family, const std::vector<Trial>& trials) {
  std::vector<results::Measured> rivals;
  for (const Trial& trial : trials)
    if (trial.family->code == family.code) rivals.push_back(trial.measured);
  return rivals;
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

std::vector<Trial> try_all(const Problem& problem, const std::vector<Family>& families, const Effort& effort,
                           Checkpoint& checkpoint) {
  std::vector<Trial> trials;
  for (const Family& family : families) {
    checkpoint.show(fmt::format("{}: {}", problem.name, family.name));
    auto tried = checkpoint.once(family.name, [&] { return try_family(problem, family, effort, rivals_of(family, trials)); });
    for (Trial& trial : tried) {
      trial.family = &family;
      trials.push_back(std::move(trial));
    }
    checkpoint.advance();
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
    join(is_ours(family.code) ? "ours" : "sundials", k);
    if (family.code == "drape" || family.code == "thesis") join("implicit", k);
    if (family.code != "drape") join(family.code, k);
    if (!family.method.empty()) join("defaults", k);
    if (!family.method.empty()) join(fmt::format("default {} by {}", family.method, family.control), k);
    join(family.name, k);
  }
  return all;
}

namespace {

/// The trials near the front of any of these.
std::set<std::size_t> near_fronts(const Problem& problem, const std::vector<Contender>& who, const std::vector<Trial>& trials) {
  std::set<std::size_t> chosen;
  for (const Contender& contender : who) {
    std::vector<results::Measured> measured;
    for (const std::size_t k : contender.members) measured.push_back(trials[k].measured);
    for (const std::size_t k : results::near_quickest(measured, asked(problem), slack)) chosen.insert(contender.members[k]);
  }
  return chosen;
}

/// Fails trials near a front whose energy cannot be, until there are none.
void judge_energies(const Problem& problem, const std::vector<Contender>& who, std::vector<Trial>& trials,
                    Checkpoint& checkpoint) {
  std::set<std::size_t> judged;
  for (bool failed = true; failed;) {
    failed = false;
    for (const std::size_t k : near_fronts(problem, who, trials)) {
      Trial& trial = trials[k];
      if (!judged.insert(k).second || !trial.configuration().energy_fault) continue;
      const std::string name = fmt::format("energy of {} {}", trial.family->name, trial.configuration().value);
      const std::string fault = checkpoint.once(name, [&] { return trial.configuration().energy_fault(); });
      if (fault.empty()) continue;
      trial.outcome = fault;
      trial.measured = {std::nan(""), {}};
      failed = true;
    }
  }
}

}  // namespace

void time_fronts(const Problem& problem, std::vector<Trial>& trials, const Effort& effort, const std::set<std::string>& named,
                 Checkpoint& checkpoint) {
  std::set<std::string> families;
  for (const Trial& trial : trials) families.insert(trial.family->name);
  std::vector<Contender> who = contenders(trials);
  std::erase_if(who, [&](const Contender& one) { return families.contains(one.name) && !named.contains(one.name); });
  time_fronts(problem, who, trials, effort, checkpoint);
}

void time_fronts(const Problem& problem, const std::vector<Contender>& who, std::vector<Trial>& trials, const Effort& effort,
                 Checkpoint& checkpoint) {
  judge_energies(problem, who, trials, checkpoint);
  const std::set<std::size_t> chosen = near_fronts(problem, who, trials);
  std::vector<Repeated> runs;
  for (const std::size_t k : chosen) {
    const auto prepare = [&problem, &solve = trials[k].configuration().solve] {
      return [&problem, &solve, cloth = std::make_shared<model::Cloth>(model::compile(problem.scene))] {
        solve(*cloth, problem.times);
      };
    };
    const bool few = trials[k].measured.times.front() > slow;
    runs.push_back({prepare, few ? std::min(fewest_repetitions, effort.repetitions) : effort.repetitions});
  }
  const auto times = checkpoint.once("times", [&] {
    return time_runs(
        runs, [] {}, effort.time_of);
  });
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
