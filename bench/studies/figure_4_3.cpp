#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "bench/draping.hpp"
#include "bench/studies.hpp"
#include "bench/timing.hpp"
#include "model/scene_file.hpp"

namespace drape::bench {
namespace {

constexpr double step = 0.01;    // s
constexpr double window = 0.05;  // s
constexpr double rest = 0.25;    ///< the last part of the run [s]
constexpr const char* methods[] = {"bdf2", "sbdf2", "implicit-euler", "imex-euler", "midpoint", "imex-midpoint"};

model::Scene swing(bool quick) {
  std::vector<model::Override> overrides;
  if (quick) overrides = {{"grid.n", "8"}};
  return model::load_scene("box_swing", overrides);
}

Cell cell(const model::Scene& scene, const char* method) { return {scene, "", &solver::method(method), step, {}}; }

/// A run with the particles that were constrained in each of its steps.
struct Trace {
  results::RunRecord run;
  std::vector<int> constrained;

  std::size_t steps() const { return constrained.size(); }
  /// Steps before the first contact.
  std::size_t free_steps() const {
    return static_cast<std::size_t>(std::ranges::find_if(constrained, [](int n) { return n > 0; }) - constrained.begin());
  }
  /// CG iterations a step, in the steps from `first` on and before `last`.
  double cg_a_step(std::size_t first, std::size_t last) const {
    double sum = 0;
    for (std::size_t k = first; k < last; ++k) sum += run.steps[k].cg_iterations;
    return sum / static_cast<double>(last - first);
  }
};

Trace trace(const Cell& cell) {
  Trace found;
  found.run = record(cell, [&](const solver::StepReport& s) {
    if (s.t > 0) found.constrained.push_back(s.contacts.constrained);
  });
  return found;
}

results::Table bars(bool quick, Progress& progress) {
  results::TableBuilder table("figure-4.3-bars", "Figure 4.3, what contact costs");
  const model::Scene scene = swing(quick);
  for (const char* method : methods) {
    const Trace with = trace(cell(scene, method));
    const auto last = with.steps(), at_rest = last - static_cast<std::size_t>(rest / step), first = with.free_steps();
    model::Scene air = scene;
    air.obstacles.clear();
    const Trace without = trace(cell(air, method));
    const auto times = time_group({cell(scene, method), cell(air, method)}, quick ? 1 : 5, [] {});
    const double tw = median(times[0]), to = median(times[1]);
    const double cgw = with.cg_a_step(0, last), cgo = without.cg_a_step(0, without.steps());
    table.row();
    table.text("m", "m", "", method);
    table.text("o", "o", "", with.run.outcome);
    table.count("f", "free steps", "", first);
    table.number("cf", "cg free", "1", "", with.cg_a_step(0, first));
    table.number("cr", "cg rest", "1", "", with.cg_a_step(at_rest, last));
    table.number("r", "ratio", "1", "", with.cg_a_step(at_rest, last) / with.cg_a_step(0, first));
    table.number("ke", "ke", "J", "", with.run.steps.back().kinetic_energy);
    table.count("c", "con", "", with.constrained.back());
    table.number("tw", "tw", "ms", "", tw);
    table.number("to", "to", "ms", "", to);
    table.number("cw", "cgw", "1", "", cgw);
    table.number("co", "cgo", "1", "", cgo);
    table.number("tr", "t ratio", "1", "", tw / to);
    table.number("tc", "t/cg ratio", "1", "", tw / cgw / (to / cgo));
    progress.advance();
  }
  return table.finish();
}

}  // namespace

std::vector<TableJob> figure_4_3(bool quick) {
  return {{6, [quick](Progress& progress) { return bars(quick, progress); }}};
}

}  // namespace drape::bench
