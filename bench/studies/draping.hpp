#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "model/scene.hpp"
#include "results/columns.hpp"
#include "results/run_record.hpp"

namespace drape::bench {

/// The work of a run as the thesis prints it: of a cloth whose scale of d it leaves open.
struct PublishedWork {
  std::int64_t updates, cg_iterations;
};

/// Table 3.1 by k, then by d, both ascending: d = 160 and 1600 N s/m, k = 10³ and 10⁵ N/m, or 10⁴, as an exponent is lost.
using PublishedBlock = std::array<std::array<std::optional<PublishedWork>, 2>, 2>;
inline constexpr PublishedBlock published_table_3_1{
    {{PublishedWork{377, 566}, PublishedWork{52, 52}}, {PublishedWork{803, 1160}, PublishedWork{198, 538}}}};

/// A method as the thesis prints it: its work, and the time on another machine [s].
struct PublishedRun {
  PublishedWork work;
  double seconds;
};

/// The tablecloth of table 3.2.
inline const std::map<std::string_view, PublishedRun> published_table_3_2{{"imex-euler", {{100, 745}, 1.69}},
                                                                          {"implicit-euler", {{206, 1038}, 3.06}},
                                                                          {"sbdf2", {{100, 304}, 1.57}},
                                                                          {"bdf2", {{122, 857}, 2.57}},
                                                                          {"midpoint", {{494, 813}, 4.39}}};

/// "success", or how a run ended else and when.
std::string ending(solver::Outcome outcome, double last_good_time);

/// What became of a falling sheet, beside what the thesis prints of it.
struct Draping {
  std::int64_t updates = 0, cg_iterations = 0;
  double sunk = 0;   ///< by which the four corners have sunk, their mean [m]
  int contacts = 0;  ///< in the last step
  solver::Outcome outcome = solver::Outcome::success;
  double last_good_time = 0;  ///< [s]
  std::optional<PublishedWork> as_published;
};

Draping draping(const model::Scene& scene, const results::RunRecord& run, const std::optional<PublishedWork>& as_published);

inline constexpr results::ColumnOf<Draping> draping_columns[] = {
    {"updates", "updates", "1", "of the fixed-point loop; of IMEX methods one a step, more in contact", results::Role::counter,
     results::field<&Draping::updates>},
    {"cg_iterations", "CG", "1", "iterations of conjugate gradients", results::Role::counter,
     results::field<&Draping::cg_iterations>},
    {"sunk", "corners sink", "m", "mean of the four corners from start to end", results::Role::quantity,
     results::field<&Draping::sunk>},
    {"contacts", "in contact", "1", "particles that touched something in the last step", results::Role::quantity,
     results::field<&Draping::contacts>},
    {"outcome", "outcome", "", "how the run ended", results::Role::outcome,
     [](const Draping& run) { return results::to_datum(ending(run.outcome, run.last_good_time)); }},
    {"thesis_updates", "thesis: updates", "1", "printed in the thesis", results::Role::note,
     [](const Draping& run) { return run.as_published ? results::to_datum(run.as_published->updates) : results::Datum(); }},
    {"thesis_cg_iterations", "thesis: CG", "1", "printed in the thesis", results::Role::note,
     [](const Draping& run) {
       return run.as_published ? results::to_datum(run.as_published->cg_iterations) : results::Datum();
     }},
};

}  // namespace drape::bench
