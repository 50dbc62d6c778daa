#include "bench/studies/studies.hpp"

#include "solver/base/registry.hpp"

namespace drape::bench {

std::span<const Study> studies() {
  static constexpr Study table[] = {
      {.name = "motions",
       .description =
           "four methods on one sheet with little damping, to be looked at: two fall too slowly, one swings too little",
       .answer = motions,
       .any_methods = true},
      {.name = "hung-sheets",
       .description =
           "all methods on the sheet of table 3.2 (without the table), hung by its edge and by two corners, d = 50 and 0.5",
       .answer = hung_sheets,
       .any_methods = true},
      {.name = "convergence",
       .description =
           "figure 2.11: equilibria against exact solutions, 5 to 160 particles a side, forces consistent and as printed",
       .answer = convergence},
      {.name = "orders",
       .description = "the order of every method in time, in a window that the program finds",
       .answer = orders,
       .any_methods = true},
      {.name = "modes",
       .description = "amplification of linear modes by the running code: stability limits, artificial inertia and damping",
       .answer = modes,
       .any_methods = true},
      {.name = "references",
       .description = "CVODE, ARKODE and IDA on the hung sheets: how far they agree, and at what cost",
       .answer = references},
      {.name = "sundials",
       .description = "SUNDIALS set up by an independent driver: its errors and CPU times reproduced",
       .answer = sundials_setups},
      {.name = "peers",
       .description = "other simulators and PETSc, run here on our springs beside our methods: errors, orders, times",
       .answer = peer_study},
      {.name = "table-3.1",
       .description = "the work of BDF(2) on the tablecloth against stiffness and damping, with the thesis' counts",
       .answer = table_3_1},
      {.name = "table-3.2",
       .description = "all methods on the tablecloth and the dress: work and time, with the thesis' figures",
       .answer = table_3_2},
      {.name = "figure-3.2",
       .description = "a sheet in the wind: what implicit Euler smooths away, against BDF(2), wave by wave",
       .answer = figure_3_2},
      {.name = "figure-3.3",
       .description = "how far semi-implicit methods lag behind BDF(2), with their artificial inertia and damping",
       .answer = figure_3_3},
      {.name = "figure-4.3",
       .description = "CG iterations and contacts over time of a sheet that swings against a box; what contact costs",
       .answer = figure_4_3},
      {.name = "table-5.1",
       .description = "virtual particles: what they cost beside the thesis' figures, what they are worth, what their jumps do",
       .answer = table_5_1},
      {.name = "detection",
       .description = "particles that meet obstacles found by half-spaces and by rays: contacts, penetration, CG, time",
       .answer = detection},
      {.name = "contact",
       .description =
           "cloth that meets itself and bodies: pairs, CG in flight and at rest, times, balances, intersections, largest steps",
       .answer = contact},
      {.name = "conditioning",
       .description = "condition of a stage's matrix and iterations against the bound (3.7); the dense inverse against solvers",
       .answer = conditioning},
      {.name = "limits",
       .description = "where \"stable under all circumstances\" ends: shear and bending that the implicit part does not know",
       .answer = limits},
      {.name = "memory",
       .description = "moduli that relax: the fit of a quality, the loss of a cycle, orders of all methods, what it costs",
       .answer = memory,
       .any_methods = true},
      {.name = "fabrics",
       .description =
           "a laboratory: fabrics are stretched, sheared and bent to and fro, hang over an edge, are let go by all methods",
       .answer = fabrics,
       .any_methods = true},
      {.name = "drape",
       .description = "Cusick's drape test of measured fabrics on three meshes: drape coefficients beside published ones",
       .answer = drape_study},
      {.name = "garments",
       .description = "garments on mannequins: time of their parts a simulated second, largest steps, distances",
       .answer = garments},
      {.name = "scaling",
       .description =
           "time of a step and of a CG iteration from 20 x 20 to a million particles, beside the machine's bandwidth",
       .answer = scaling},
      {.name = "strips",
       .description =
           "one huge sheet in strips over MPI: the same motion in any number of processes, time, messages, reductions, memory",
       .answer = strips_study},
      {.name = "stability",
       .description = "what becomes of every method over stiffness and damping, its largest usable step, and stress cases",
       .answer = stability,
       .any_methods = true},
      {.name = "stages",
       .description = "stage solvers on the same stages of implicit Euler: updates, forces, time to a residual",
       .answer = stages},
      {.name = "step-control",
       .description = "steps of the thesis' loop by its passes, against constant steps and control of the error",
       .answer = step_control},
      {.name = "tolerance",
       .description = "error over tolerance of every method on the scenes without obstacles, 1e-2 to 1e-7",
       .answer = tolerance,
       .any_methods = true},
      {.name = "choice",
       .description = "which method to use: the quickest with automatic solvers, over damping, size and error",
       .answer = choice},
      {.name = "size",
       .description = "20 x 20 to 320 x 320 particles and two garments: who is the quickest, and whether small sheets mislead",
       .answer = sizes},
      {.name = "auto",
       .description =
           "what --method auto chooses, against the quickest that a search finds: times, errors, and how often it holds",
       .answer = automatic_study},
      {.name = "field",
       .description =
           "all methods on sheets of three sizes: error, lag, energy, momentum, work, time; which family wins, by how much",
       .answer = field_study,
       .any_methods = true},
      {.name = "claims",
       .description = "the ledger: what the thesis and the field say of integrators, measured: confirmed, refuted, only if",
       .answer = claims},
      {.name = "work-precision",
       .description = "time against error of all methods and solvers, and of SUNDIALS, tuned: who wins, and by what ratio",
       .answer = work_precision,
       .any_methods = true,
       .any_scene = true},
      {.name = "bars", .description = "work-precision, judged by what this project wants of itself", .answer = bars},
  };
  return table;
}

Methods all_or(Methods methods) {
  if (methods.empty())
    for (const solver::Method& method : solver::methods()) methods.push_back(&method);
  return methods;
}

Methods converging_or(Methods methods) {
  if (!methods.empty()) return methods;
  methods = all_or({});
  std::erase_if(methods, [](const solver::Method* method) { return !method->converges; });
  return methods;
}

const Study& study(std::string_view name) { return base::find_named(studies(), "study", name); }

}  // namespace drape::bench
