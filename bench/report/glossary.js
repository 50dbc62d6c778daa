// The words of the page: where one stands in a text or above a column, a tip explains it. Names of methods, solvers and
// scenes come with the data, as the program's own tables describe them. `head`: only above columns, as it is an
// ordinary word.
export const glossary = [
  {word: "scene", says: "the cloth, its material, what holds it, forces and obstacles", head: true},
  {word: "method", says: "time integrator, and after slashes how it solves its equations", head: true},
  {word: "step", says: "time step h that was asked for", head: true},
  {word: "steps", says: "time steps that were taken", head: true},
  {word: "set", says: "what was set differently from the scene", head: true},
  {word: "median", says: "median of the repetitions' times", head: true},
  {word: "max", says: "largest of the repetitions' times", head: true},
  {word: "wall min", says: "least of the repetitions' times"},
  {word: "updates", says: "corrections of the iterate of a stage; each costs the forces and a linear system"},
  {word: "CG", says: "iterations of conjugate gradients, which solve linear systems; none where these are factorised"},
  {
    word: "ν_h",
    says:
        "numerical stiffness h² k / (ρ l²): how stiff the springs are for a step of this size; explicit methods need " +
        "smaller steps as it grows"
  },
  {
    word: "h k/d",
    says: "step times stiffness over damping; where it is large, semi-implicit methods are stable and wrong"
  },
  {
    word: "rms error",
    says:
        "root of the mean squared distance from the reference at the end, divided by the size of the scene; 0.01 is 1 %"
  },
  {word: "over the run", says: "the largest such error at any tenth of the run"},
  {word: "of its motion", says: "the largest such error, divided by how far the cloth moves rather than by its size"},
  {
    word: "reference",
    says: "the same scene computed by two solvers of SUNDIALS from different families, far more accurately"
  },
  {
    word: "reference error",
    says: "how far the two solvers of the reference disagree; errors below ten times that say nothing"
  },
  {word: "size", says: "largest extent of the cloth at the start", head: true},
  {word: "order", says: "p where the error falls like h to the power of p", head: true},
  {word: "fitted", says: "order of convergence fitted to the errors: p where these fall like h to the power of p"},
  {word: "stable and wrong", says: "it does not fail, and ends more than 5 % of the size away from the reference"},
  {word: "unstable", says: "stopped because its energy exceeded what the scene can have"},
  {word: "semi-implicit", says: "springs implicitly and all else explicitly: one linear system a step"},
  {word: "growth", says: "growth of a small perturbation of the start; beyond 100 an error says little about a method"},
  {word: "SUNDIALS", says: "library of general solvers for differential equations, here with our forces and factors"},
  {word: "tuned", says: "the best of many settings, chosen with hindsight"},
  {word: "by steps", says: "in equal steps of this size, in seconds"},
  {word: "by tolerance", says: "in steps that the method chooses to keep its estimate of the error below this"},
  {word: "by fraction", says: "in sub-steps of this fraction of the stability limit"},
  {word: "quartiles", says: "a quarter of the repetitions took less than the lower, a quarter more than the upper"},
  {word: "clearance", says: "least distance of a particle from an obstacle, negative inside"},
  {word: "linear theory", says: "what the eigenvalues of one step on one spring predict"}
];
