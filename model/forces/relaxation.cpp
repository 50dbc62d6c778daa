#include <algorithm>
#include <cmath>
#include <utility>

#include "model/forces/term.hpp"
#include "model/memory/path.hpp"
#include "model/sheet/metric.hpp"

namespace drape::model {
namespace {

using solver::State;

/// The part of a pull that Maxwell elements have forgotten, of every edge and of every quadrant of a cell: minus the stiffness
/// times r = Σ Y ζ, where dζ/dt = ω (ε − ζ). The strain of an edge is |p|/l − 1, of a quadrant <p, q> less
/// than at rest [m²].
class RelaxingStrains final : public TermMemory {
 public:
  RelaxingStrains(const Sheet& sheet, Spectrum spectrum);

  int variables() const override { return elements() * lines(); }
  void begin(int order, double t, const State& y, const Variables& z) override;
  void pass(double t, const State& y, const Variables& z) override;
  void carry(double t, const State& y, MutableVariables z) override;
  void rate(const State& y, const Variables& z, MutableVariables dz) const override;
  void respond(double gamma, const State& y, const Variables& r, const State& d, MutableVariables dz) const override;
  double energy(const State& y, const Variables& z) const override;

  void add_force(const Configuration& c, Vectors& f);
  void add_jacobian(const Configuration& c, const JacobianEntries& entries);

 private:
  /// An edge or, if both are there, a quadrant.
  struct Element {
    EdgeEnds p, q;
    double length;     ///< of an edge; 0 for a quadrant
    double rest;       ///< <p, q> of a quadrant at rest [m²]
    double stiffness;  ///< pull per strain: [N] of an edge, [N/m³] of a quadrant
    double volume;     ///< energy per stiffness, strain and strain: l of an edge, 1 of a quadrant

    bool edge() const { return length > 0; }
  };

  int elements() const { return static_cast<int>(elements_.size()); }
  int lines() const { return static_cast<int>(spectrum_.size()); }

  static double strain(const Element& e, const Vectors& x);
  static double strain_rate(const Element& e, const Vectors& x, const Vectors& v);

  void strains(const State& y, Eigen::VectorXd& strain, Eigen::VectorXd& rate) const;
  void weigh(double h);
  double kept_of(int e, int l) const;
  void end_path(double t);
  double forgotten(int e, const Vectors& x, const Vectors& v) const;

  Spectrum spectrum_;
  std::vector<Element> elements_;
  int nodes_ = 2;

  // Where the motion has passed last, and before.
  double t_ = 0, h_before_ = 0;  ///< h_before_: 0 if the state before is not known
  Eigen::VectorXd strain_, rate_, z_, strain_before_, rate_before_;

  struct Path {
    int nodes;
    double h, older;  ///< [s]; the step before over h
  };

  // The path to a time: r is `kept_`, plus the strain times `slope_`, plus its rate times `rate_slope_`.
  Path path_{0, 0, 0};  ///< that the weights are of
  double end_ = 0, slope_ = 0, rate_slope_ = 0;
  bool path_known_ = false;
  std::vector<double> decay_;
  std::vector<PathWeights> weights_;
  Eigen::VectorXd kept_;
};

RelaxingStrains::RelaxingStrains(const Sheet& sheet, Spectrum spectrum)
    : spectrum_(std::move(spectrum)), decay_(spectrum_.size()), weights_(spectrum_.size()) {
  const Material& m = sheet.material;
  for (const Edge& edge : edges(sheet.grid))
    if (const double k = along(m.tension, edge); k > 0)
      elements_.push_back({{edge.i, edge.j}, {}, edge.length, 0, k * edge.width, edge.length});
  if (m.shear == 0) return;
  const Metric metric(sheet.grid);
  for (const Cell& cell : cells(sheet.grid))
    for (const auto& [p, q] : quadrants(cell))
      elements_.push_back({p, q, 0, metric.product(p, q), m.shear / (4 * metric.quadrant_measure(cell, p, q)), 1});
}

double RelaxingStrains::strain(const Element& e, const Vectors& x) {
  const Eigen::Vector3d p = difference(x, e.p);
  return e.edge() ? p.norm() / e.length - 1 : p.dot(difference(x, e.q)) - e.rest;
}

double RelaxingStrains::strain_rate(const Element& e, const Vectors& x, const Vectors& v) {
  const Eigen::Vector3d p = difference(x, e.p), dp = difference(v, e.p);
  return e.edge() ? p.dot(dp) / (p.norm() * e.length) : dp.dot(difference(x, e.q)) + p.dot(difference(v, e.q));
}

void RelaxingStrains::strains(const State& y, Eigen::VectorXd& strain_of, Eigen::VectorXd& rate_of) const {
  strain_of.resize(elements());
  rate_of.setZero(elements());
  for (int e = 0; e < elements(); ++e) {
    strain_of[e] = strain(elements_[e], y.x);
    if (nodes_ > 2) rate_of[e] = strain_rate(elements_[e], y.x, y.v);
  }
}

void RelaxingStrains::begin(int order, double t, const State& y, const Variables& z) {
  nodes_ = order <= 2 ? 2 : order <= 4 ? 4 : 6;
  h_before_ = 0;
  t_ = t;
  path_known_ = false;
  strains(y, strain_, rate_);
  z_ = z;
}

void RelaxingStrains::pass(double t, const State& y, const Variables& z) {
  if (t == t_) return;
  h_before_ = std::max(0.0, t - t_);
  std::swap(strain_, strain_before_);
  std::swap(rate_, rate_before_);
  t_ = t;
  path_known_ = false;
  strains(y, strain_, rate_);
  z_ = z;
}

/// Weights of the path of h. Equal sub-steps share them: the round-off of times is all in which they differ. A path that leads
/// far back, to a state that the motion has passed long ago, changes nothing: its exponentials would explode.
void RelaxingStrains::weigh(double h) {
  constexpr double farthest_back = -0.5, most_uneven = 100, round_off = 1e-11;
  const double size = std::abs(h);
  const bool knows_before = h_before_ > 0 && h_before_ >= size / most_uneven && h_before_ <= most_uneven * size;
  const Path path{nodes_ == most_nodes && !knows_before ? 4 : nodes_, h, knows_before ? h_before_ / h : 0};
  const auto same = [](double a, double b) { return std::abs(a - b) <= round_off * std::abs(b); };
  if (path.nodes == path_.nodes && same(path.h, path_.h) && same(path.older, path_.older)) return;
  path_ = path;
  slope_ = rate_slope_ = 0;
  for (int l = 0; l < lines(); ++l) {
    const double theta = spectrum_[l].rate * h;
    const bool stays = h == 0 || theta < farthest_back;
    decay_[l] = stays ? 1 : std::exp(-theta);
    PathWeights& w = weights_[l];
    w = stays ? PathWeights{} : path_weights(theta, path.nodes, path.older);
    for (const Node rates : {rate_at_begin, rate_at_end, rate_before}) w[rates] *= h;
    slope_ += spectrum_[l].part * w[at_end];
    rate_slope_ += spectrum_[l].part * w[rate_at_end];
  }
}

/// ζ at the end of the path without what the strain there adds.
double RelaxingStrains::kept_of(int e, int l) const {
  const PathWeights& w = weights_[l];
  const double kept = decay_[l] * z_[e * lines() + l] + w[at_begin] * strain_[e] + w[rate_at_begin] * rate_[e];
  return path_.nodes < most_nodes ? kept : kept + w[before] * strain_before_[e] + w[rate_before] * rate_before_[e];
}

void RelaxingStrains::end_path(double t) {
  if (path_known_ && t == end_) return;
  weigh(t - t_);
  kept_.setZero(elements());
  for (int e = 0; e < elements(); ++e)
    for (int l = 0; l < lines(); ++l) kept_[e] += spectrum_[l].part * kept_of(e, l);
  end_ = t;
  path_known_ = true;
}

void RelaxingStrains::carry(double t, const State& y, MutableVariables z) {
  path_known_ = path_known_ && t == end_;
  weigh(t - t_);
  for (int e = 0; e < elements(); ++e) {
    const double strain1 = strain(elements_[e], y.x), rate1 = nodes_ > 2 ? strain_rate(elements_[e], y.x, y.v) : 0;
    for (int l = 0; l < lines(); ++l) {
      const PathWeights& w = weights_[l];
      z[e * lines() + l] = kept_of(e, l) + w[at_end] * strain1 + w[rate_at_end] * rate1;
    }
  }
}

void RelaxingStrains::rate(const State& y, const Variables& z, MutableVariables dz) const {
  for (int e = 0; e < elements(); ++e) {
    const double now = strain(elements_[e], y.x);
    for (int l = 0; l < lines(); ++l) dz[e * lines() + l] = spectrum_[l].rate * (now - z[e * lines() + l]);
  }
}

void RelaxingStrains::respond(double gamma, const State& y, const Variables& r, const State& d, MutableVariables dz) const {
  for (int e = 0; e < elements(); ++e) {
    const double change = strain_rate(elements_[e], y.x, d.x);
    for (int l = 0; l < lines(); ++l) {
      const double g = gamma * spectrum_[l].rate;
      dz[e * lines() + l] = (r[e * lines() + l] + g * change) / (1 + g);
    }
  }
}

/// ½ M_l (ε − ζ)² of every Maxwell element is stored, of which tension and shear count ½ M_l ε².
double RelaxingStrains::energy(const State& y, const Variables& z) const {
  double energy = 0;
  for (int e = 0; e < elements(); ++e) {
    const double now = strain(elements_[e], y.x);
    double density = 0;
    for (int l = 0; l < lines(); ++l) {
      const double zeta = z[e * lines() + l];
      density += spectrum_[l].part * zeta * (0.5 * zeta - now);
    }
    energy += elements_[e].stiffness * elements_[e].volume * density;
  }
  return energy;
}

double RelaxingStrains::forgotten(int e, const Vectors& x, const Vectors& v) const {
  const double rates = rate_slope_ == 0 ? 0 : rate_slope_ * strain_rate(elements_[e], x, v);
  return kept_[e] + slope_ * strain(elements_[e], x) + rates;
}

void RelaxingStrains::add_force(const Configuration& c, Vectors& f) {
  end_path(c.t);
  for (int i = 0; i < elements(); ++i) {
    const Element& e = elements_[i];
    const double pull = -e.stiffness * forgotten(i, c.x, c.v);
    const Eigen::Vector3d p = difference(c.x, e.p);
    if (e.edge()) {
      add_pull(f, e.p, pull / p.norm() * p);
    } else {
      add_pull(f, e.p, pull * difference(c.x, e.q));
      add_pull(f, e.q, pull * p);
    }
  }
}

/// Exact where a path begins, and on linear paths. Newton's matrices are those of the elastic sheet, which are stiffer.
void RelaxingStrains::add_jacobian(const Configuration& c, const JacobianEntries& entries) {
  if (!entries.exact()) return;
  end_path(c.t);
  const auto& dx = entries.add_dx;
  for (int i = 0; i < elements(); ++i) {
    const Element& e = elements_[i];
    const double pull = -e.stiffness * forgotten(i, c.x, c.v), slope = -e.stiffness * slope_;
    const Eigen::Vector3d p = difference(c.x, e.p);
    if (e.edge()) {
      const Eigen::Vector3d n = p.normalized();
      const Eigen::Matrix3d nn = n * n.transpose();
      add_edge_pair(dx, e.p, e.p, slope / e.length * nn + pull / p.norm() * (Eigen::Matrix3d::Identity() - nn));
      continue;
    }
    const Eigen::Vector3d q = difference(c.x, e.q);
    const Eigen::Matrix3d turned = pull * Eigen::Matrix3d::Identity();
    add_edge_pair(dx, e.p, e.p, slope * q * q.transpose());
    add_edge_pair(dx, e.p, e.q, turned + slope * q * p.transpose());
    add_edge_pair(dx, e.q, e.p, turned + slope * p * q.transpose());
    add_edge_pair(dx, e.q, e.q, slope * p * p.transpose());
  }
}

}  // namespace

/// Memory of tension and shear: σ = k (ε − Σ Y ζ), dζ/dt = ω (ε − ζ) [Etzmuß 2002, 2.4.2; Emmerich, Korn 1987]. The moduli are
/// those of sudden strains. Bending does not remember.
std::optional<Term> make_relaxation(const Sheet& sheet) {
  const Material& m = sheet.material;
  Spectrum spectrum = m.relaxation.spectrum();
  const bool strains = m.tension.any() || (m.shear > 0 && m.shear_form == ShearForm::conservative);
  if (spectrum.empty() || !strains) return {};
  const auto relaxation = std::make_shared<RelaxingStrains>(sheet, std::move(spectrum));

  Term term;
  term.memory = relaxation;
  term.force = [=](const Configuration& c, Vectors& f) { relaxation->add_force(c, f); };
  term.jacobian = [=](const Configuration& c, const JacobianEntries& entries) { relaxation->add_jacobian(c, entries); };
  return term;
}

}  // namespace drape::model
