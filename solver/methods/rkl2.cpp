#include "solver/methods/stabilised.hpp"
#include "solver/stability.hpp"

namespace drape::solver {
namespace {

class Rkl2Weights {
 public:
  explicit Rkl2Weights(double stages) : w_(4 / (stages * stages + stages - 2)) {}

  StageWeights next() {
    const double j = ++j_, mu_tilde = b(j) * w_;
    if (j == 1) return {0, 0, mu_tilde, 0};
    const double mu = (2 * j - 1) * b(j) / (j * b(j - 1)), nu = -(j - 1) * b(j) / (j * b(j - 2)), a = 1 - b(j - 1);
    return {mu, nu, mu * w_, -a * mu * w_};
  }

 private:
  static double b(double j) { return j < 2 ? 1.0 / 3 : (j * j + j - 2) / (2 * j * (j + 1)); }

  double w_, j_ = 0;
};

}  // namespace

// The stability polynomial of s stages is a_s + b_s P_s(1 + w z) with Legendre's P_s, at most 1 for z from −(s² + s − 2)/2 to 0
// [Meyer, Balsara, Aslam 2014].
void rkl2(Step& s, double stages) {
  three_term_recurrence(s, stages, Rkl2Weights(stages));
  s.error.constant = 1.0 / 18;
}

// As many stages as the largest damping rate of the sheet demands. Motion is stable only if it is damped enough: oscillations
// far from the real axis grow, whatever the number of stages.
void rkl2(Step& s) {
  if (const double stages = stages_of(s, rkl2_stages); stages > 0) rkl2(s, stages);
}

}  // namespace drape::solver
