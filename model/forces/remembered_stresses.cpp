#include "model/forces/remembered_stresses.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/dense_output.hpp"

namespace drape::model {

using solver::State;

void RememberedStresses::add(const Strain& strain, std::shared_ptr<const StressLaw> law, bool stiff) {
  elements_.push_back({strain, std::move(law), stiff});
}

/// From the slope by the strain: over the square of the length.
double RememberedStresses::Element::spring() const { return slope * strain.area() / (strain.length() * strain.length()); }

void RememberedStresses::pass(double, const State& y, const Variables& z) {
  bool changed = false;
  for (int e = 0; e < variables(); ++e) {
    Element& element = elements_[e];
    element.from = element.strain.value(y.x);
    element.z = z[e];
    if (!element.stiff) continue;
    const double slope = element.law->branch_slope(element.from, element.z);
    changed = changed || slope != element.slope;
    element.slope = slope;
  }
  changes_ += changed ? 1 : 0;
}

void RememberedStresses::carry(double, const State& y, MutableVariables z) {
  for (int e = 0; e < variables(); ++e) {
    const Element& element = elements_[e];
    z[e] = element.law->carry(element.strain.value(y.x), element.from, element.z);
  }
}

void RememberedStresses::rate(const State& y, const Variables& z, MutableVariables dz) const {
  for (int e = 0; e < variables(); ++e) {
    const Strain& strain = elements_[e].strain;
    dz[e] = elements_[e].law->rate(strain.value(y.x), strain.rate(y.x, y.v), z[e]);
  }
}

void RememberedStresses::respond(double gamma, const State& y, const Variables& r, const State& d, MutableVariables dz) const {
  for (int e = 0; e < variables(); ++e) {
    const Strain& strain = elements_[e].strain;
    const double slope = elements_[e].law->variable_slope(strain.value(y.x), strain.rate(y.x, y.v), elements_[e].z);
    dz[e] = r[e] + (slope == 0 ? 0 : gamma * slope * strain.rate(y.x, d.v));
  }
}

double RememberedStresses::energy(const State& y, const Variables& z) const {
  double energy = 0;
  for (int e = 0; e < variables(); ++e)
    energy += elements_[e].strain.area() * elements_[e].law->energy(elements_[e].strain.value(y.x), z[e]);
  return energy;
}

void RememberedStresses::add_branches(const State& y, const Variables& z, std::vector<int>& now) const {
  for (int e = 0; e < variables(); ++e) {
    const Strain& strain = elements_[e].strain;
    now.push_back(elements_[e].law->branch(strain.value(y.x), strain.rate(y.x, y.v), z[e]));
  }
}

double RememberedStresses::first_kink(double h, double from, const State& y0, const Variables& z, const State& y1) const {
  constexpr double precision = 1e-9;
  if (from >= 1) return 1;
  const auto branches_at = [&](double part) {
    const State y = solver::state_within(part * h, 0, y0, h, y1);
    std::vector<int> now;
    for (int e = 0; e < variables(); ++e) {
      const auto& [strain, law, stiff, passed, passed_z, slope] = elements_[e];
      const double value = strain.value(y.x);
      now.push_back(law->branch(value, strain.rate(y.x, y.v), law->carry(value, strain.value(y0.x), z[e])));
    }
    return now;
  };
  const std::vector<int> before = branches_at(from);
  if (branches_at(1) == before) return 1;
  double low = from, high = 1;
  while (high - low > precision) {
    const double middle = 0.5 * (low + high);
    (branches_at(middle) == before ? low : high) = middle;
  }
  return high;
}

void RememberedStresses::add_stiffness(std::vector<Eigen::Triplet<double>>& entries) const {
  for (const Element& element : elements_)
    if (element.stiff) add_spring(entries, element.strain.edge(), element.spring());
}

void RememberedStresses::add_springs(const Vectors& x, Vectors& f) const {
  for (const Element& element : elements_)
    if (element.stiff) add_pull(f, element.strain.edge(), element.spring() * difference(x, element.strain.edge()));
}

void RememberedStresses::add_rest(const Vectors& x, Vectors& f) const {
  Strain::Gradient by;
  for (const Element& element : elements_) {
    const Strain& strain = element.strain;
    strain.add_force(element.stress(strain.value(x, by)).value, by, f);
    if (element.stiff) add_pull(f, strain.edge(), -element.spring() * difference(x, strain.edge()));
  }
}

/// Where the motion stands at the place that it has passed last, slopes are those of the side to which it goes.
void RememberedStresses::add_jacobian(const Configuration& c, const JacobianEntries& entries) const {
  Strain::Gradient by;
  for (const Element& element : elements_) {
    const Strain& strain = element.strain;
    if (entries.curvature == Curvature::tension && !strain.couples_edge()) continue;
    double now = strain.value(c.x, by);
    if (now == element.from) now = std::nextafter(now, std::copysign(HUGE_VAL, strain.rate(c.x, c.v)));
    auto [stress, slope] = element.stress(now);
    if (!entries.exact()) {
      slope = std::max(slope, 0.0);
      stress = strain.couples_edge() ? std::max(stress, 0.0) : 0;  // the curvature of other strains is indefinite
    }
    strain.add_jacobian(c.x, stress, slope, by, entries.add_dx);
  }
}

void add_shear(const Grid& grid, const std::shared_ptr<const StressLaw>& law, RememberedStresses& stresses) {
  const Metric metric(grid);
  for (const Cell& cell : cells(grid))
    for (const auto& [p, q] : quadrants(cell)) stresses.add(Strain::of_quadrant(metric, cell, p, q), law);
}

void add_bending(const Grid& grid, const std::shared_ptr<const StressLaw>& weft, const std::shared_ptr<const StressLaw>& warp,
                 RememberedStresses& stresses) {
  if (!weft && !warp) return;  // curvatures cost more than all else of a sheet
  for (const LineCurvature& curvature : line_curvatures(grid))
    if (const auto& law = curvature.weft ? weft : warp) stresses.add(curvature.strain, law);
}

std::optional<Term> remembering_term(const std::shared_ptr<RememberedStresses>& stresses) {
  if (stresses->empty()) return {};
  Term term;
  term.memory = stresses;
  term.without_energy = true;  // laws have one on each branch, which depends on what is remembered
  term.springs = [=](const Vectors& x, Vectors& f) { stresses->add_springs(x, f); };
  term.force = [=](const Configuration& c, Vectors& f) { stresses->add_rest(c.x, f); };
  term.jacobian = [=](const Configuration& c, const JacobianEntries& entries) { stresses->add_jacobian(c, entries); };
  return term;
}

}  // namespace drape::model
