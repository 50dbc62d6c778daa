#include "solver/methods/stabilised.hpp"
#include "solver/stability.hpp"

namespace drape::solver {
namespace {

/// Chebyshev's T_j with its derivatives at a point, beginning with j = 1.
class Chebyshev {
 public:
  explicit Chebyshev(double x) : x_(x), now_(x, 1, 0) {}

  /// To j + 1, by T_{j+1} = 2 x T_j − T_{j−1} and its derivatives.
  void advance() {
    const Eigen::Vector3d next = 2 * x_ * now_ + Eigen::Vector3d(0, 2 * now_[0], 4 * now_[1]) - before_;
    before_ = now_;
    now_ = next;
  }

  double value() const { return now_[0]; }
  double slope() const { return now_[1]; }
  double curvature() const { return now_[2]; }

 private:
  double x_;
  Eigen::Vector3d before_{1, 0, 0}, now_;
};

class Rkc2Weights {
 public:
  explicit Rkc2Weights(double stages) : w0_(1 + rkc2_damping / (stages * stages)), T_(w0_) {
    Chebyshev last(w0_);
    for (double j = 1; j < stages; ++j) last.advance();
    w1_ = last.slope() / last.curvature();
    b_ = b_before_ = 1 / (4 * w0_ * w0_);  // b_0 = b_1 = b_2
  }

  StageWeights next() {
    if (first_) {
      first_ = false;
      return {0, 0, b_ * w1_, 0};
    }
    const double a = 1 - b_ * T_.value();  // of j − 1
    T_.advance();
    const double b = T_.curvature() / (T_.slope() * T_.slope());
    const StageWeights weights{2 * b * w0_ / b_, -b / b_before_, 2 * b * w1_ / b_, -a * 2 * b * w1_ / b_};
    b_before_ = b_;
    b_ = b;
    return weights;
  }

 private:
  double w0_, w1_, b_, b_before_;
  Chebyshev T_;
  bool first_ = true;
};

}  // namespace

// The stability polynomial of s stages is 1 − b_s T_s(w0) + b_s T_s(w0 + w1 z) with Chebyshev's T_s, w0 = 1 + ε/s², at most 1
// for z from −2/3 (s² − 1) (1 − 2/15 ε) to 0   [Sommeijer, Shampine, Verwer 1998].
void rkc2(Step& s, double stages) {
  three_term_recurrence(s, stages, Rkc2Weights(stages));
  s.error.constant = 1.0 / 15;
}

// As many stages as the largest damping rate of the sheet demands. Motion is stable only if it is damped enough: oscillations
// far from the real axis grow, whatever the number of stages.
void rkc2(Step& s) {
  if (const double stages = stages_of(s, rkc2_stages); stages > 0) rkc2(s, stages);
}

}  // namespace drape::solver
