#include "bench/studies/work_precision/runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <utility>

#include "bench/runs/timing.hpp"
#include "reference/distance.hpp"

namespace drape::bench {
namespace {

/// Below this multiple of the truth's uncertainty an error says nothing.
constexpr double too_exact = 1;

/// A configuration that is slower by this factor than another of the same code twice in a row will not win, unless finer steps
/// take hardly more time: it may be the quickest at smaller errors, if it is not yet slower by far, or so coarse that nothing
/// follows.
constexpr double hopeless = 2, by_far = 8;
constexpr double hardly_more = 1.3, coarse_error = 1e-2;

/// Steps may be so coarse that nothing converges in time: this many are left out then, as long as no finer one has succeeded.
constexpr std::size_t leap = 4;

/// Runs that take longer [ms] are repeated so often: the fewest times that still show a spread.
constexpr double slow = 100;
constexpr int fewest_repetitions = 3;

/// Runs under the energy guard may take longer by this factor.
constexpr double longer_guarded = 10;

/// A first run may have been slower than others by this factor by chance.
constexpr double slack = 1.4;

double seconds(TimeOf time_of) {
  timespec now{};
  clock_gettime(time_of == TimeOf::wall ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Sum of the counters with these names, ours and those of SUNDIALS' packages: each run has some of them.
std::int64_t count(const solver::Counters& work, std::initializer_list<std::string_view> names) {
  std::int64_t sum = 0;
  for (const solver::Counters::Kind& kind : work.kinds())
    if (std::ranges::find(names, kind.name) != names.end()) sum += kind.count;
  return sum;
}

void note_work(const solver::Counters& work, ComparedRun& run) {
  run.forces = count(work, {"forces", "explicit_forces"});
  run.factorisations = count(
      work, {"newton_factorisations", "factorisations", "cvode/factorisations", "arkode/factorisations", "ida/factorisations"});
  run.steps = count(work, {"steps", "cvode/steps", "arkode/steps", "ida/steps"});
}

ComparedRun run_variant(const Problem& problem, const Configuration& configuration, std::size_t place, const Effort& effort) {
  ComparedRun run{.configuration = &configuration, .place = place};
  const model::Cloth cloth = model::compile(problem.scene);
  const double begin = seconds(effort.time_of);
  Solved solved = run.variant().solve(cloth, problem.times, effort.limits);
  const double milliseconds = 1e3 * (seconds(effort.time_of) - begin);
  note_work(*cloth.ode.work, run);
  run.outcome = solved.end.result.outcome;
  if (!solved.end.succeeded()) {
    run.exclude(solved.end.result.message);
    return run;
  }
  const auto positions = reference::positions_of(std::move(solved.states));
  run.measured = {reference::largest_rms_distance(positions, problem.truth) / problem.length, {milliseconds}};
  const std::int64_t starting = count(*cloth.ode.work, {"starting_steps"});
  if (!std::isfinite(run.measured.error)) {
    run.outcome = solver::Outcome::not_finite;
    run.exclude("not finite");
  } else if (2 * starting > run.steps) {
    run.exclude(fmt::format("{} of {} steps are another method's, which starts it", starting, run.steps));
  }
  return run;
}

/// Whether a rival was as exact and quicker by this factor.
bool outdone(const results::Measured& run, const std::vector<results::Measured>& rivals, double factor) {
  return !run.times.empty() && std::ranges::any_of(rivals, [&](const results::Measured& other) {
    return !other.times.empty() && other.error <= run.error && factor * other.times[0] < run.times[0];
  });
}

/// `rivals`: other runs of the same code.
std::vector<ComparedRun> run_configuration(const Problem& problem, const Configuration& configuration, const Effort& effort,
                                           std::vector<results::Measured> rivals) {
  std::vector<ComparedRun> runs;
  int times_outdone = 0;
  double before = INFINITY;
  bool succeeded = false;
  for (std::size_t k = 0; k < configuration.variants.size();) {
    const double begin = seconds(effort.time_of);
    const ComparedRun& run = runs.emplace_back(run_variant(problem, configuration, k, effort));
    const double taken = seconds(effort.time_of) - begin;
    const bool too_long = taken > 0.7 * effort.limits.seconds;
    succeeded |= run.counts();
    const bool slower = taken > hardly_more * before;
    const bool lost = !configuration.advised && (slower || run.measured.error <= coarse_error) &&
                      outdone(run.measured, rivals, slower ? hopeless : by_far);
    times_outdone = lost ? times_outdone + 1 : 0;
    before = taken;
    rivals.push_back(run.measured);
    const bool exact = run.measured.error < std::max(too_exact * problem.uncertainty, problem.enough);
    if ((too_long && succeeded) || exact || times_outdone > 1) break;
    k += too_long ? leap : 1;
  }
  return runs;
}

std::vector<results::Measured> rivals_of(const Configuration& configuration, const std::vector<ComparedRun>& runs) {
  std::vector<results::Measured> rivals;
  for (const ComparedRun& run : runs)
    if (run.configuration->code == configuration.code) rivals.push_back(run.measured);
  return rivals;
}

}  // namespace

void ComparedRun::exclude(std::string why) {
  reason = std::move(why);
  measured = {std::nan(""), {}};
}

std::string DefaultChoice::name() const {
  return method == nullptr ? "" : fmt::format("{} by {}", method->name, to_string(control));
}

Contender of_code(Code code) {
  return [code](const Configuration& configuration) { return configuration.code == code; };
}

Contender named(const std::string& name) {
  return [name](const Configuration& configuration) { return configuration.name == name; };
}

Contender only(const Configuration& configuration) {
  return [&configuration](const Configuration& other) { return &other == &configuration; };
}

std::vector<double> usual_errors() {
  std::vector<double> all;
  for (int digits = 1; digits <= 7; ++digits) all.push_back(std::pow(10.0, -digits));
  return all;
}

bool resolves(const Problem& problem, double error) {
  constexpr double part = 0.3;  // of an error that the truth may be uncertain by
  return problem.uncertainty <= part * error;
}

std::vector<double> levels(const Problem& problem) {
  std::vector<double> all = usual_errors();
  std::erase_if(all, [&](double error) { return !resolves(problem, error); });
  return all;
}

std::vector<double> asked(const Problem& problem) {
  std::vector<double> all = levels(problem);
  all.insert(all.end(), problem.asked.begin(), problem.asked.end());
  return all;
}

std::vector<ComparedRun> run_all(const Problem& problem, const std::vector<Configuration>& configurations, const Effort& effort,
                                 Checkpoint& checkpoint) {
  std::vector<ComparedRun> runs;
  for (const Configuration& configuration : configurations) {
    checkpoint.show(fmt::format("{}: {}", problem.name, configuration.name));
    auto some = checkpoint.timed(
        configuration.name, [&] { return run_configuration(problem, configuration, effort, rivals_of(configuration, runs)); });
    for (ComparedRun& run : some) {
      run.configuration = &configuration;
      runs.push_back(std::move(run));
    }
    checkpoint.advance();
  }
  return runs;
}

namespace {

/// What was measured of the runs of a contender, and their places.
struct Measurements {
  std::vector<results::Measured> measured;
  std::vector<std::size_t> places;
};

Measurements measurements(const Contender& contender, const std::vector<ComparedRun>& runs) {
  Measurements of;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    if (!contender(*runs[k].configuration)) continue;
    of.measured.push_back(runs[k].measured);
    of.places.push_back(k);
  }
  return of;
}

/// The places of the runs near the front of any of these.
std::set<std::size_t> near_fronts(const Problem& problem, const std::vector<Contender>& who,
                                  const std::vector<ComparedRun>& runs) {
  std::set<std::size_t> chosen;
  for (const Contender& contender : who) {
    const auto [measured, places] = measurements(contender, runs);
    for (const std::size_t k : results::near_quickest(measured, asked(problem), slack)) chosen.insert(places[k]);
  }
  return chosen;
}

/// Excludes runs near a front whose energy cannot be, until there are none.
void guard_energies(const Problem& problem, const std::vector<Contender>& who, std::vector<ComparedRun>& runs, Limits limits,
                    Checkpoint& checkpoint) {
  limits.seconds *= longer_guarded;
  std::set<std::size_t> guarded;
  for (bool excluded = true; excluded;) {
    excluded = false;
    for (const std::size_t k : near_fronts(problem, who, runs)) {
      ComparedRun& run = runs[k];
      if (!guarded.insert(k).second) continue;
      const std::string id = fmt::format("energy of {} {}", run.configuration->name, run.variant().value);
      const solver::RunResult result = checkpoint.once(id, [&] { return run.variant().guarded(limits).result; });
      if (result.outcome == solver::Outcome::success) continue;
      run.outcome = result.outcome;
      run.exclude(result.message);
      excluded = true;
    }
  }
}

}  // namespace

void time_fronts(const Problem& problem, std::vector<ComparedRun>& runs, const Effort& effort,
                 const std::set<std::string>& names, Checkpoint& checkpoint) {
  std::vector<Contender> who{&Configuration::is_ours, &Configuration::is_sundials, &Configuration::is_implicit,
                             &Configuration::is_default};
  std::set<Code> codes;
  std::set<const Configuration*> defaults;
  for (const ComparedRun& run : runs) {
    codes.insert(run.configuration->code);
    if (run.configuration->is_default()) defaults.insert(run.configuration);
  }
  for (const Code code : codes)
    if (code != Code::drape) who.push_back(of_code(code));
  for (const Configuration* configuration : defaults) who.push_back(only(*configuration));
  for (const std::string& name : names) who.push_back(named(name));
  time_fronts(problem, who, runs, effort, checkpoint);
}

void time_fronts(const Problem& problem, const std::vector<Contender>& who, std::vector<ComparedRun>& runs,
                 const Effort& effort, Checkpoint& checkpoint) {
  guard_energies(problem, who, runs, effort.limits, checkpoint);
  const std::set<std::size_t> chosen = near_fronts(problem, who, runs);
  std::vector<Repeated> repeated;
  for (const std::size_t k : chosen) {
    const auto prepare = [&problem, &solve = runs[k].variant().solve] {
      return [&problem, &solve, cloth = std::make_shared<model::Cloth>(model::compile(problem.scene))] {
        solve(*cloth, problem.times, {});
      };
    };
    const bool few = runs[k].measured.times.front() > slow;
    repeated.push_back({prepare, few ? std::min(fewest_repetitions, effort.repetitions) : effort.repetitions});
  }
  const auto times = checkpoint.timed("times", [&] {
    return time_runs(
        repeated, [] {}, effort.time_of);
  });
  for (std::size_t place = 0; const std::size_t k : chosen) {
    runs[k].measured.times = times[place++];
    runs[k].timed = true;
  }
}

const ComparedRun* quickest(const Contender& contender, const std::vector<ComparedRun>& runs, double error) {
  auto [measured, places] = measurements(contender, runs);
  for (std::size_t k = 0; k < places.size(); ++k)
    if (!runs[places[k]].timed) measured[k].times.clear();
  const auto best = results::quickest(measured, error);
  return best ? &runs[places[*best]] : nullptr;
}

}  // namespace drape::bench
