#include <array>
#include <cmath>

#include "solver/methods/acceleration.hpp"

namespace drape::solver {
namespace {

/// A Runge-Kutta method whose first stage is the start of the step and whose last is its end; all except the first have the
/// same a_ii. b̂: weights of the embedded method.
struct Tableau {
  int stages;
  std::array<double, 6> c;
  std::array<std::array<double, 6>, 6> a;
  std::array<double, 6> b_hat;
};

/// Typical error of such a step over h^(p+1) times a derivative.
constexpr double embedded_error = 0.01;

void add(double weight, const State& rate, Vectors& x, Vectors& v) {
  if (weight == 0) return;
  x += weight * rate.x;
  v += weight * rate.v;
}

/// Sets the rates at the start, with M⁻¹ f from the last stage of the step before if there was one.
void start_rate(Step& s) {
  Point& now = s.now();
  if (!now.has_f) {
    acceleration(s.ode, s.t, now.y, now.f);
    now.has_f = true;
  }
  State& rate = s.scratch.rates[0];
  rate.x = now.y.v;
  rate.v = now.f;
}

// Y_i = y0 + h Σ_{j<i} a_ij F_j + h a_ii F_i with F = (v, M⁻¹ f);   y1 = Y_s;   error = h Σ (a_sj − b̂_j) F_j
void esdirk(Step& s, const Tableau& T) {
  Vectors &ax = s.scratch.ax, &av = s.scratch.av;
  std::vector<State>& rates = s.scratch.rates;
  rates.resize(T.stages);
  start_rate(s);
  State& y = s.y1();
  for (int i = 1; i < T.stages; ++i) {
    ax = s.y0().x;
    av = s.y0().v;
    for (int j = 0; j < i; ++j) add(s.h * T.a[i][j], rates[j], ax, av);
    const double gamma = s.h * T.a[i][i];
    if (!s.solve({gamma, s.t + T.c[i] * s.h, ax, av}, embedded_error)) return;
    rates[i].x = y.v;
    rates[i].v = (y.v - av) / gamma;
  }
  State& error = s.error.estimate;
  error.x.setZero(y.x.rows(), 3);
  error.v.setZero(y.v.rows(), 3);
  for (int j = 0; j < T.stages; ++j) add(s.h * (T.a[T.stages - 1][j] - T.b_hat[j]), rates[j], error.x, error.v);
  s.next.f = rates[T.stages - 1].v;
  s.next.has_f = true;
  s.error.embedded = true;
}

}  // namespace

// The trapezoidal rule to t + γh, then BDF(2): a_ii = γ/2, γ = 2 − √2   [Bank et al. 1985; Hosea, Shampine 1996]
void tr_bdf2(Step& s) {
  static const double g = 1 - std::sqrt(0.5), w = std::sqrt(0.125);
  static const Tableau T{3, {0, 2 * g, 1}, {{{}, {g, g}, {w, w, g}}}, {(1 - w) / 3, (3 * w + 1) / 3, g / 3}};
  esdirk(s, T);
}

// ARK3(2)4L[2]SA, its implicit half   [Kennedy, Carpenter 2003]
void esdirk3(Step& s) {
  constexpr double g = 1767732205903.0 / 4055673282236.0;
  constexpr std::array<double, 6> b{1471266399579.0 / 7840856788654.0, -4482444167858.0 / 7529755066697.0,
                                    11266239266428.0 / 11593286722821.0, g};
  static constexpr Tableau T{4,
                             {0, 2 * g, 0.6, 1},
                             {{{}, {g, g}, {2746238789719.0 / 10658868560708.0, -640167445237.0 / 6845629431997.0, g}, b}},
                             {2756255671327.0 / 12835298489170.0, -10771552573575.0 / 22201958757719.0,
                              9247589265047.0 / 10645013368117.0, 2193209047091.0 / 5459859503100.0}};
  esdirk(s, T);
}

// ARK4(3)6L[2]SA, its implicit half   [Kennedy, Carpenter 2003]
void esdirk4(Step& s) {
  constexpr double g = 0.25;
  constexpr std::array<double, 6> b{82889.0 / 524892, 0, 15625.0 / 83664, 69875.0 / 102672, -2260.0 / 8211, g};
  static constexpr Tableau T{
      6,
      {0, 0.5, 83.0 / 250, 31.0 / 50, 17.0 / 20, 1},
      {{{},
        {g, g},
        {8611.0 / 62500, -1743.0 / 31250, g},
        {5012029.0 / 34652500, -654441.0 / 2922500, 174375.0 / 388108, g},
        {15267082809.0 / 155376265600, -71443401.0 / 120774400, 730878875.0 / 902184768, 2285395.0 / 8070912, g},
        b}},
      {4586570599.0 / 29645900160, 0, 178811875.0 / 945068544, 814220225.0 / 1159782912, -3700637.0 / 11593932,
       61727.0 / 225920}};
  esdirk(s, T);
}

}  // namespace drape::solver
