#include "solver/methods/rosenbrock.hpp"

#include <cmath>
#include <numeric>

#include "solver/base/registry.hpp"
#include "solver/methods/acceleration.hpp"

namespace drape::solver {
namespace {

constexpr double ros2_gamma = 1 - 0.70710678118654752440;         // 1 − √½: L-stable
constexpr double ros3p_gamma = 0.5 + 1.73205080756887729353 / 6;  // ½ + √3/6
constexpr double ros34_gamma = 4.3586652150845900e-01;

constexpr RosenbrockTableau tableaus[] = {
    // [Verwer et al. 1999]
    {.name = "ros2",
     .stages = 2,
     .order = 2,
     .w_method = true,
     .gamma = ros2_gamma,
     .a = {{{}, {1}}},
     .gammas = {{{}, {-2 * ros2_gamma}}},
     .b = {0.5, 0.5},
     .b_hat = {1, 0}},
    // [Lang, Verwer 2001]
    {.name = "ros3p",
     .stages = 3,
     .order = 3,
     .w_method = false,
     .gamma = ros3p_gamma,
     .a = {{{}, {1}, {1, 0}}},
     .gammas = {{{}, {-1}, {-ros3p_gamma, 0.5 - 2 * ros3p_gamma}}},
     .b = {2.0 / 3, 0, 1.0 / 3},
     .b_hat = {1.0 / 3, 1.0 / 3, 1.0 / 3}},
    // [Sandu et al. 1997]
    {.name = "rodas3",
     .stages = 4,
     .order = 3,
     .w_method = false,
     .gamma = 0.5,
     .a = {{{}, {}, {1, 0}, {0.75, -0.25, 0.5}}},
     .gammas = {{{}, {1}, {-0.25, -0.25}, {1.0 / 12, 1.0 / 12, -2.0 / 3}}},
     .b = {5.0 / 6, -1.0 / 6, -1.0 / 6, 0.5},
     .b_hat = {0.75, -0.25, 0.5, 0}},
    // [Rang, Angermann 2005]
    {.name = "ros34pw2",
     .stages = 4,
     .order = 3,
     .w_method = true,
     .gamma = ros34_gamma,
     .a = {{{}, {8.7173304301691801e-01}, {8.4457060015369423e-01, -1.1299064236484185e-01}, {0, 0, 1}}},
     .gammas = {{{},
                 {-8.7173304301691801e-01},
                 {-9.0338057013044082e-01, 5.4180672388095326e-02},
                 {2.4212380706095346e-01, -1.2232505839045147e+00, 5.4526025533510214e-01}}},
     .b = {2.4212380706095346e-01, -1.2232505839045147e+00, 1.5452602553351020e+00, 4.3586652150845900e-01},
     .b_hat = {3.7810903145819369e-01, -9.6042292212423178e-02, 0.5, 2.1793326075422950e-01}},
};

/// y += scale Σ w_j k_j over the first `count` stages.
void add_stages(double scale, const RosenbrockTableau::Row& weights, int count, const std::vector<State>& k, State& y) {
  for (int j = 0; j < count; ++j) {
    if (weights[j] == 0) continue;
    y.x += scale * weights[j] * k[j].x;
    y.v += scale * weights[j] * k[j].v;
  }
}

double sum(const RosenbrockTableau::Row& row) { return std::accumulate(row.begin(), row.end(), 0.0); }

// k_i = h F(t0 + α_i h, y0 + Σ a_ij k_j) + h J Σ γ_ij k_j + γ_i h² ∂F/∂t,   y1 = y0 + Σ b_i k_i,   error = Σ (b_i − b̂_i) k_i
// with F = (v, M⁻¹ f), α_i = Σ a_ij, γ_i = Σ γ_ij   [Hairer, Wanner 1996, IV.7], without products with J:
//   (1 − γ h J) (k_i + s_i) = h F_i + s_i + γ_i h² ∂F/∂t,   s_i = Σ γ_ij k_j/γ, j < i
// `solve(r, z)` finds z of (1 − γ h J) z = r and says whether it did. Where J is not the Jacobian, nor is ∂F/∂t needed.
template <class Solve>
void rosenbrock(Step& s, const RosenbrockTableau& T, bool exact, const Solve& solve) {
  std::vector<State>& k = s.scratch.rates;
  k.resize(T.stages + 2);
  State &r = k[T.stages], &s_i = k[T.stages + 1], &y = s.y1();
  if (exact) find_time_derivative(s);
  for (int i = 0; i < T.stages; ++i) {
    y = s.y0();
    add_stages(1, T.a[i], i, k, y);
    s_i.x.setZero(y.x.rows(), 3);
    s_i.v.setZero(y.v.rows(), 3);
    add_stages(1 / T.gamma, T.gammas[i], i, k, s_i);
    r.x = s.h * y.v + s_i.x;
    r.v.resize(y.v.rows(), 3);
    s.ode.force(s.t + sum(T.a[i]) * s.h, y.x, y.v, r.v);
    r.v = s.h * (s.ode.mass.cwiseInverse().asDiagonal() * r.v) + s_i.v;
    if (exact) r.v += (T.gamma + sum(T.gammas[i])) * s.scratch.f_hat;
    if (!solve(r, k[i])) return;
    k[i].x -= s_i.x;
    k[i].v -= s_i.v;
  }
  y = s.y0();
  add_stages(1, T.b, T.stages, k, y);
  State& error = s.error.estimate;
  error.x.setZero(y.x.rows(), 3);
  error.v.setZero(y.v.rows(), 3);
  add_stages(1, T.b, T.stages, k, error);
  add_stages(-1, T.b_hat, T.stages, k, error);
  s.error.embedded = true;
}

/// With the exact Jacobian.
void rosenbrock(Step& s, std::string_view name) {
  const RosenbrockTableau& T = base::find_named(rosenbrock_tableaus(), "Rosenbrock method", name);
  if (!s.linearise(T.gamma * s.h, s.t, s.y0())) return;
  rosenbrock(s, T, true, [&s](const State& r, State& z) {
    s.solve_linearised(r, z);
    return true;
  });
}

}  // namespace

std::span<const RosenbrockTableau> rosenbrock_tableaus() { return tableaus; }

void ros2(Step& s) { rosenbrock(s, "ros2"); }
void ros3p(Step& s) { rosenbrock(s, "ros3p"); }
void rodas3(Step& s) { rosenbrock(s, "rodas3"); }
void ros34pw2(Step& s) { rosenbrock(s, "ros34pw2"); }

// With the constant K and D in the place of the Jacobian.
void with_constant_matrix(Step& s, std::string_view name) {
  const RosenbrockTableau& T = base::find_named(rosenbrock_tableaus(), "Rosenbrock method", name);
  const double gamma = T.gamma * s.h;
  rosenbrock(s, T, false,
             [&s, gamma](const State& r, State& z) { return s.accept(s.stage->solve_increment(gamma, s.y0(), r, z)); });
}
void ros2_w(Step& s) { with_constant_matrix(s, "ros2"); }
void ros34pw2_w(Step& s) { with_constant_matrix(s, "ros34pw2"); }

}  // namespace drape::solver
