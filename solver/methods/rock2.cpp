#include "solver/methods/rock2.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <map>

#include "solver/stability.hpp"

namespace drape::solver {
namespace {

constexpr double ripple = 0.95;

/// Value and three derivatives at a point.
using Jet = Eigen::Vector4d;

/// (x − a) p at x, with derivatives.
Jet times_linear(double x, double a, const Jet& p) { return (x - a) * p + Jet(0, p[0], 2 * p[1], 3 * p[2]); }

/// Where f changes its sign between two points, by false position, which converges faster than by halves.
template <class Function>
double zero_between(double from, double to, const Function& f) {
  double at_from = f(from), at_to = f(to);
  for (int k = 0; k < 100 && std::abs(to - from) > 1e-15 * std::abs(to); ++k) {
    const double middle = to - at_to * (to - from) / (at_to - at_from), value = f(middle);
    if (value == 0) return middle;
    if ((value > 0) == (at_to > 0)) {
      at_from /= 2;  // Illinois: the other end may not stay for long
    } else {
      from = to;
      at_from = at_to;
    }
    to = middle;
    at_to = value;
  }
  return to;
}

/// The orthonormal polynomials for a weight w²/√(1 − x²), by their recurrence β_{j+1} p_{j+1} = (x − α_j) p_j − β_j p_{j−1}.
class Orthonormal {
 public:
  Orthonormal(int degree, double c, double g) : alpha_(degree), beta_(degree + 1), c_(c), g_(g) {
    const int n = degree + 8;  // exact to degree 2 n − 1
    const Eigen::ArrayXd x = (Eigen::ArrayXd::LinSpaced(n, 0.5, n - 0.5) * M_PI / n).cos();
    Eigen::ArrayXd weight = ((x - c).square() + g * g).square();
    weight /= weight.sum();
    Eigen::ArrayXd before = Eigen::ArrayXd::Zero(n), last = Eigen::ArrayXd::Ones(n), next(n);
    beta_[0] = 0;
    for (int j = 0; j < degree; ++j) {
      alpha_[j] = (weight * x * last.square()).sum();
      next = (x - alpha_[j]) * last - beta_[j] * before;
      beta_[j + 1] = std::sqrt((weight * next.square()).sum());
      before = last;
      last = next / beta_[j + 1];
    }
  }

  double alpha(int j) const { return alpha_[j]; }
  double beta(int j) const { return beta_[j]; }

  /// w p at x, where w = (x − c)² + g².
  Jet weighted(double x) const {
    Jet before = Jet::Zero(), p(1, 0, 0, 0);
    for (int j = 0; j < alpha_.size(); ++j) {
      const Jet next = (times_linear(x, alpha_[j], p) - beta_[j] * before) / beta_[j + 1];
      before = p;
      p = next;
    }
    return times_linear(x, c_, times_linear(x, c_, p)) + g_ * g_ * p;
  }

  /// The largest |w p| for x from −1 to 1.
  double amplitude() const {
    const auto samples = 32 * (alpha_.size() + 2);
    const Eigen::ArrayXd x = (Eigen::ArrayXd::LinSpaced(samples, 0, M_PI)).cos();
    Eigen::ArrayXd before = Eigen::ArrayXd::Zero(samples), p = Eigen::ArrayXd::Ones(samples), next(samples);
    for (int j = 0; j < alpha_.size(); ++j) {
      next = ((x - alpha_[j]) * p - beta_[j] * before) / beta_[j + 1];
      before = p;
      p = next;
    }
    return (((x - c_).square() + g_ * g_) * p).abs().maxCoeff();
  }

  /// Where w p comes to its amplitude over the ripple, beyond 1.
  double normalised_at() const {
    const double wanted = amplitude() / ripple;
    const double degree = static_cast<double>(alpha_.size()) + 2;
    return zero_between(1, 1 + 4 / (degree * degree), [&](double x) { return weighted(x)[0] / wanted - 1; });
  }

 private:
  Eigen::ArrayXd alpha_, beta_;
  double c_, g_;
};

struct Polynomials {
  explicit Polynomials(const SplitOde&) {}

  const Rock2Polynomial& of(int stages) { return known.try_emplace(stages, stages).first->second; }

  std::map<int, Rock2Polynomial> known;
};

}  // namespace

Rock2Polynomial::Rock2Polynomial(int stages) {
  const double scale = 2.0 / (static_cast<double>(stages) * stages), c = 1 - 1.5 * scale;
  const auto excess = [&](double width) {  // of R'' over R'²
    const Orthonormal p(stages - 2, c, width * scale);
    const Jet value = p.weighted(p.normalised_at());
    return value[2] * value[0] / (value[1] * value[1]) - 1;
  };
  const double g = zero_between(1.2, 2.2, excess) * scale;
  const Orthonormal p(stages - 2, c, g);
  a = p.normalised_at();
  const Jet R = p.weighted(a) / p.weighted(a)[0];
  d = 1 / R[1];
  third = R[3] * d * d * d;
  const double w = (a - c) * (a - c) + g * g;
  sigma = d * (a - c) / w;
  tau = d * d / w;
  double before = 0, now = 1;  // p_{j−1}, p_j at a
  for (int j = 0; j < stages - 2; ++j) {
    const double next = ((a - p.alpha(j)) * now - p.beta(j) * before) / p.beta(j + 1), q = 1 / (p.beta(j + 1) * next);
    weights.push_back({(a - p.alpha(j)) * now * q, -p.beta(j) * before * q, d * now * q, 0});
    before = now;
    now = next;
  }
}

void rock2(Step& s, const Rock2Polynomial& polynomial) {
  struct InTurn {
    const StageWeights* at;
    StageWeights next() { return *at++; }
  };
  const double sigma = polynomial.sigma, of_first = 2 * sigma - polynomial.tau / sigma, of_second = polynomial.tau / sigma;
  const double c = three_term_recurrence(s, static_cast<double>(polynomial.weights.size()), InTurn{polynomial.weights.data()});
  State &y = s.y1(), &second = s.scratch.rates[0];
  Vectors& a = s.scratch.f_hat;
  acceleration(s.ode, s.t + c * s.h, y, a);
  second.x = y.x + s.h * sigma * y.v;
  second.v = y.v + s.h * sigma * a;
  y.x += s.h * (of_first * y.v + of_second * second.v);
  y.v += s.h * of_first * a;
  acceleration(s.ode, s.t + (c + sigma) * s.h, second, a);
  y.v += s.h * of_second * a;
  s.error.constant = (1 - polynomial.third) / 6;
}

// As many stages as the largest damping rate of the sheet demands. Motion is stable only if it is damped enough: oscillations
// far from the real axis grow, whatever the number of stages.
void rock2(Step& s) {
  if (const double stages = stages_of(s, rock2_stages, 500); stages > 0)
    rock2(s, s.keep<Polynomials>().of(static_cast<int>(stages)));
}

}  // namespace drape::solver
