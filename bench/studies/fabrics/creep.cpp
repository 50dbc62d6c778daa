#include <cmath>
#include <vector>

#include "bench/runs/checkpoint_json.hpp"
#include "bench/studies/fabrics/fabrics.hpp"
#include "bench/studies/fabrics/sample.hpp"
#include "model/memory/spectrum.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"
#include "solver/base/decompositions.hpp"

namespace drape::bench {
namespace {

using results::ColumnOf;
using results::field;
using results::Part;
using results::Role;

constexpr model::Band band = {0.01, 1000};            // [rad/s]
constexpr double first_time = 1e-3, last_time = 100;  // [s]: steps are even up to the first and grow with time from there on
constexpr double load = 4.9;                          // [N/m], about half of what Kawabata's instrument ends with

/// The strain under a constant load over the strain at once: that of dζ/dt = ω (1 + Σ Y ζ − ζ), 1 + Σ Y ζ, by the eigenvectors
/// of the matrix, which is symmetric in ζ sqrt(Y/ω).
class Creep {
 public:
  explicit Creep(const model::Spectrum& spectrum) {
    const auto n = static_cast<Eigen::Index>(spectrum.size());
    Eigen::VectorXd g(n);
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index l = 0; l < n; ++l) {
      g[l] = std::sqrt(spectrum[l].rate * spectrum[l].part);
      A(l, l) = -spectrum[l].rate;
    }
    A += g * g.transpose();
    eigen_ = base::symmetric_eigen(A);
    parts_ = (eigen_.vectors.transpose() * g).array().square();
  }

  double strain(double t) const { return 1 + (parts_ * ((eigen_.values.array() * t).exp() - 1) / eigen_.values.array()).sum(); }

 private:
  base::SymmetricEigen eigen_;
  Eigen::ArrayXd parts_;
};

struct CreepPoint {
  double quality = 0, time = 0, strain = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CreepPoint, quality, time, strain)

struct CreepTest {
  double quality = 0;
  std::int64_t steps = 0;  ///< a decade
  double at_once = 0, at_end = 0, exact = 0, error = 0;
  std::vector<CreepPoint> curve = {};
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CreepTest, quality, steps, at_once, at_end, exact, error, curve)

/// The strain with which the sample carries the load. Stress is linear in it.
double strain_under_load(Sample& sample, double t, double guess) {
  const double stress = sample.stress(t, guess), next = 1.01 * guess;
  return guess + (load - stress) * (next - guess) / (sample.stress(t, next) - stress);
}

/// The first fabric, with linear moduli; relative strains are the same for all.
CreepTest creep(double quality, int steps) {
  model::Scene scene = sample_of(model::fabrics().front());
  model::Material& m = scene.sheet.material;
  m.law = model::StretchLaw::linear;
  m.relaxation.quality = quality;
  m.relaxation.band = band;
  Sample sample(scene, instruments().front());
  const Creep exact(m.relaxation.spectrum());
  CreepTest result{quality, steps};
  result.at_once = load / m.tension.weft;
  sample.begin(0, result.at_once);
  double strain = result.at_once;
  const int count = static_cast<int>(std::lround(steps * std::log10(1 + last_time / first_time)));
  for (int k = 1; k <= count; ++k) {
    const double t = first_time * (std::pow(10, static_cast<double>(k) / steps) - 1);
    strain = strain_under_load(sample, t, strain);
    sample.pass(t, strain);
    result.curve.push_back({quality, t, strain / result.at_once});
    result.error = std::max(result.error, std::abs(strain / (result.at_once * exact.strain(t)) - 1));
  }
  result.at_end = strain / result.at_once;
  result.exact = exact.strain(result.curve.back().time);
  return result;
}

constexpr int most_steps = 80;
constexpr double allowed = 1e-4;

std::vector<CreepTest> creep_of_all(Checkpoint& checkpoint) {
  std::vector<CreepTest> all;
  for (const double quality : {5.0, 10.0, 20.0, 100.0})
    for (int steps = most_steps / 4; steps <= most_steps; steps *= 2) all.push_back(creep(quality, steps));
  checkpoint.advance();
  return all;
}

constexpr ColumnOf<CreepTest> creep_columns[] = {
    {"quality", "Q", "1", "of tension, from 0.01 to 1000 rad/s", Role::key, field<&CreepTest::quality>},
    {"steps", "steps", "1", "a decade of time", Role::key, field<&CreepTest::steps>},
    {"at_once", "at once", "1", "strain under 4.9 N/m before anything relaxes", Role::quantity, field<&CreepTest::at_once>},
    {"at_end", "after 100 s", "1", "strain over that at once", Role::quantity, field<&CreepTest::at_end>},
    {"exact", "closed form", "1", "the same by the eigenvectors of the Maxwell elements", Role::quantity,
     field<&CreepTest::exact>},
    {"error", "error", "1", "largest of the strain at any time, relatively", Role::error, field<&CreepTest::error>},
    {"verdict", "verdict", "", "whether the error of the shortest steps is below 1e-4", Role::verdict,
     [](const CreepTest& row) {
       if (row.steps != most_steps) return results::Datum();
       return results::to_datum(results::check(row.error < allowed, "below 1e-4", "not below 1e-4"));
     }},
};

constexpr ColumnOf<CreepPoint> curve_columns[] = {
    {"quality", "Q", "1", "of tension", Role::key, field<&CreepPoint::quality>},
    {"time", "t", "s", "since the load acts", Role::quantity, field<&CreepPoint::time>},
    {"strain", "strain", "1", "over that at once", Role::quantity, field<&CreepPoint::strain>},
};

std::vector<results::Table> creep_tables(const std::vector<CreepTest>& tests) {
  std::vector<CreepPoint> points;
  for (const CreepTest& test : tests)
    if (test.steps == most_steps) points.insert(points.end(), test.curve.begin(), test.curve.end());
  results::Table curves =
      results::make_table("creep-curves", "Strain under a load that stays, over that at once", curve_columns, points);
  draw(curves, results::Figure::curves, {{Part::curve, "quality"}, {Part::x, "time"}, {Part::y, "strain"}});
  return {results::make_table("creep", "A sample under a load that stays, against the closed form", creep_columns, tests),
          curves};
}

}  // namespace

Job creep_tests() { return job("creep", 1, creep_of_all, creep_tables); }

}  // namespace drape::bench
