#include "bench/studies/studies.hpp"

#include "solver/base/registry.hpp"

namespace drape::bench {

std::span<const Study> studies() {
  static constexpr Study table[] = {
      {"motions", "four methods on one sheet with little damping, to be looked at: two fall too slowly, one swings too little",
       motions, nullptr},
      {"hung-sheets",
       "all methods on the sheet of table 3.2 (without the table), hung by its edge and by two corners, d = 50 and 0.5",
       hung_sheets, nullptr},
      {"convergence",
       "figure 2.11: equilibria against exact solutions, 5 to 160 particles a side, forces consistent and as printed", nullptr,
       convergence},
      {"orders", "the order of every method in time, in a window that the program finds", nullptr, nullptr, {}, orders},
      {"modes",
       "amplification of linear modes by the running code: stability limits, artificial inertia and damping",
       nullptr,
       nullptr,
       {},
       modes},
      {"references", "CVODE, ARKODE and IDA on the hung sheets: how far they agree, and at what cost", nullptr, references},
      {"peers", "SUNDIALS set up by an independent driver: its errors and CPU times reproduced", nullptr, peers},
      {"table-3.1", "the work of BDF(2) on the tablecloth against stiffness and damping, with the thesis' counts", nullptr,
       table_3_1},
      {"table-3.2", "all methods on the tablecloth: work and time, with the thesis' figures", nullptr, table_3_2},
      {"figure-3.2", "a sheet in the wind: what implicit Euler smooths away, against BDF(2), wave by wave", nullptr,
       figure_3_2},
      {"figure-3.3", "how far semi-implicit methods lag behind BDF(2), with their artificial inertia and damping", nullptr,
       figure_3_3},
      {"figure-4.3", "CG iterations and contacts over time of a sheet that swings against a box; what contact costs", nullptr,
       figure_4_3},
      {"scaling", "time of a step and of a CG iteration from 20 x 20 to a million particles, beside the machine's bandwidth",
       nullptr, scaling},
      {"stability", "what becomes of every method over stiffness and damping, its largest usable step, and stress cases",
       nullptr, nullptr, "studies/plot_stability.py", stability},
      {"tolerance",
       "error over tolerance of every method on the scenes without obstacles, 1e-2 to 1e-7",
       nullptr,
       nullptr,
       {},
       tolerance},
      {"work-precision", "time against error of all methods and solvers, and of SUNDIALS, tuned: who wins, and by what ratio",
       nullptr, nullptr, "studies/plot_work_precision.py", work_precision, work_precision_of},
      {"bars", "work-precision, judged by what this project wants of itself", nullptr, bars, "studies/plot_work_precision.py"},
  };
  return table;
}

Methods all_or(Methods methods) {
  if (methods.empty())
    for (const solver::Method& method : solver::methods()) methods.push_back(&method);
  return methods;
}

const Study& study(std::string_view name) { return base::find_named(studies(), "study", name); }

}  // namespace drape::bench
