#include "bench/studies/contact/responses.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/studies/contact/contact_runs.hpp"
#include "bench/studies/draping.hpp"
#include "bench/studies/step_means.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"

namespace drape::bench {
namespace {

using results::ColumnOf;
using results::Datum;
using results::field;
using results::Role;
using results::RunRecord;
using results::Standing;
using results::Verdict;

constexpr const char* response_scenes[] = {"box_swing", "tablecloth", "ball"};
constexpr const char* response_methods[] = {"sbdf2", "imex-euler", "implicit-euler", "bdf2", "midpoint"};

/// A method with a response to obstacles.
struct ResponseRun {
  std::string scene, method, response, outcome;
  std::int64_t systems = 0, cg_iterations = 0;
  std::optional<double> rest = {};  ///< CG iterations a step
  double clearance = 0, energy_rise = 0;
  Verdict verdict = {};
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ResponseRun, scene, method, response, outcome, systems, cg_iterations, rest, clearance,
                                   energy_rise)

constexpr ColumnOf<ResponseRun> response_columns[] = {
    {"scene", "scene", "", "built-in", Role::key, field<&ResponseRun::scene>},
    {"method", "method", "", "time integrator, h = 0.01 s, with the thesis' solvers", Role::key, field<&ResponseRun::method>},
    {"response", "response", "", "contact.response", Role::key, field<&ResponseRun::response>},
    {"systems", "systems", "1", "linear systems", Role::counter, field<&ResponseRun::systems>},
    {"cg_iterations", "CG", "1", "iterations of conjugate gradients", Role::counter, field<&ResponseRun::cg_iterations>},
    {"rest", "rest", "1", "CG iterations a step in the last 20, if the cloth rests then", Role::counter,
     field<&ResponseRun::rest>},
    {"clearance", "clearance", "m", "least distance of a particle from an obstacle", Role::quantity,
     field<&ResponseRun::clearance>},
    {"energy_rise", "energy rise", "1", "largest rise of the total energy, over the run's energies", Role::quantity,
     field<&ResponseRun::energy_rise>},
    {"outcome", "outcome", "", "how the run ended", Role::outcome, field<&ResponseRun::outcome>},
    {"verdict", "verdict", "", "whether the constraint needs no more CG iterations at rest than this response", Role::verdict,
     [](const ResponseRun& row) { return row.response == contact_responses[0] ? Datum() : results::to_datum(row.verdict); }},
};

ResponseRun response_row(const std::string& name, std::string_view method, std::string_view response, bool quick) {
  const WatchedRun one = watched(contact_spec(contact_scene(name, quick, response), method));
  const RunRecord& run = one.run;
  return {name,
          std::string(method),
          std::string(response),
          ending(run.outcome, run.last_good_time),
          work_count(run, "updates"),
          work_count(run, "cg_iterations"),
          iterations_of(parts_of(one).rest),
          run.contact->clearance,
          run.contact->energy_rise};
}

Verdict beside_constraint(const ResponseRun& constraint, const ResponseRun& other) {
  if (!constraint.rest || !other.rest) return {Standing::open, "does not rest"};
  return results::check(*constraint.rest <= *other.rest, "constraint needs no more CG at rest",
                        "constraint needs more CG at rest");
}

std::vector<ResponseRun> response_rows(std::span<const char* const> scenes, std::span<const char* const> methods, bool quick,
                                       Checkpoint& checkpoint) {
  std::vector<ResponseRun> rows;
  checkpoint.each(scenes, [&](const std::string scene) {
    checkpoint.each(methods, [&](const std::string_view method) {
      const auto constraint = rows.size();
      for (const std::string_view response : contact_responses) {
        const std::string id = fmt::format("{} {} {}", scene, method, response);
        checkpoint.show(id);
        rows.push_back(checkpoint.once(id, [&] { return response_row(scene, method, response, quick); }));
        rows.back().verdict = beside_constraint(rows[constraint], rows.back());
      }
      checkpoint.advance();
    });
  });
  return rows;
}

}  // namespace

Job compare_responses(bool quick) {
  const auto scenes = some_of(response_scenes, quick, 1), methods = some_of(response_methods, quick, 1);
  return job(
      "contact-responses", static_cast<int>(scenes.size() * methods.size()),
      [=](Checkpoint& checkpoint) { return response_rows(scenes, methods, quick, checkpoint); },
      [](const std::vector<ResponseRun>& rows) {
        return results::make_table("contact-responses", "Responses to obstacles: what resting costs", response_columns, rows);
      });
}

}  // namespace drape::bench
