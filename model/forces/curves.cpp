#include <algorithm>

#include "model/forces/term.hpp"
#include "model/memory/curve.hpp"
#include "model/sheet/cells.hpp"

namespace drape::model {
namespace {

using solver::State;

/// Tension by measured curves. An internal variable of each edge is the largest strain that it has had; between accepted states
/// strains change in one direction. K takes the slope C of the branch, C w/l (x_j − x_i), the remainder is explicit.
class CurvedTension final : public TermMemory {
 public:
  explicit CurvedTension(const Sheet& sheet);

  bool acts() const { return !edges_.empty(); }

  int variables() const override { return static_cast<int>(edges_.size()); }
  void begin(int, double, const State& y, const Variables& z) override { pass(0, y, z); }
  void pass(double, const State& y, const Variables& z) override;
  void carry(double, const State& y, MutableVariables z) override;
  void rate(const State& y, const Variables& z, MutableVariables dz) const override;
  void respond(double, const State&, const Variables& r, const State&, MutableVariables dz) const override { dz = r; }
  double energy(const State& y, const Variables& z) const override;

  std::int64_t stiffness_changes() const override { return changes_; }
  void add_stiffness(std::vector<Eigen::Triplet<double>>& entries) const override;

  void add_springs(const Vectors& x, Vectors& f) const;
  void add_rest(const Vectors& x, Vectors& f) const;
  void add_jacobian(const Vectors& x, const JacobianEntries& entries) const;

 private:
  static Eigen::Vector3d along_edge(const Edge& edge, const Vectors& x) { return difference(x, {edge.i, edge.j}); }
  static double strain(const Edge& edge, const Vectors& x) { return along_edge(edge, x).norm() / edge.length - 1; }

  const StressCurve& curve(const Edge& edge) const { return edge.weft ? weft_ : warp_; }

  StressCurve weft_, warp_;
  std::vector<Edge> edges_;
  Eigen::VectorXd largest_, slope_;
  std::int64_t changes_ = 0;
};

CurvedTension::CurvedTension(const Sheet& sheet) : weft_(sheet.material.weft_curve), warp_(sheet.material.warp_curve) {
  for (const Edge& edge : edges(sheet.grid))
    if (curve(edge).given()) edges_.push_back(edge);
  largest_.setZero(variables());
  slope_.setZero(variables());
}

void CurvedTension::pass(double, const State& y, const Variables& z) {
  largest_ = z;
  bool changed = false;
  for (int e = 0; e < variables(); ++e) {
    const double slope = curve(edges_[e]).slope(strain(edges_[e], y.x), largest_[e]);
    changed = changed || slope != slope_[e];
    slope_[e] = slope;
  }
  changes_ += changed ? 1 : 0;
}

void CurvedTension::carry(double, const State& y, MutableVariables z) {
  for (int e = 0; e < variables(); ++e) z[e] = std::max(largest_[e], strain(edges_[e], y.x));
}

void CurvedTension::rate(const State& y, const Variables& z, MutableVariables dz) const {
  for (int e = 0; e < variables(); ++e) {
    const Eigen::Vector3d p = along_edge(edges_[e], y.x);
    const double rate = p.dot(along_edge(edges_[e], y.v)) / (p.norm() * edges_[e].length);
    dz[e] = strain(edges_[e], y.x) < z[e] ? 0 : std::max(0.0, rate);
  }
}

double CurvedTension::energy(const State& y, const Variables& z) const {
  double energy = 0;
  for (int e = 0; e < variables(); ++e) {
    const Edge& edge = edges_[e];
    energy += curve(edge).recoverable(strain(edge, y.x), z[e]) * edge.length * edge.width;
  }
  return energy;
}

void CurvedTension::add_stiffness(std::vector<Eigen::Triplet<double>>& entries) const {
  for (int e = 0; e < variables(); ++e) {
    const Edge& edge = edges_[e];
    add_spring(entries, edge, slope_[e] * edge.width / edge.length);
  }
}

void CurvedTension::add_springs(const Vectors& x, Vectors& f) const {
  for (int e = 0; e < variables(); ++e) {
    const Edge& edge = edges_[e];
    add_pull(f, {edge.i, edge.j}, slope_[e] * edge.width / edge.length * along_edge(edge, x));
  }
}

void CurvedTension::add_rest(const Vectors& x, Vectors& f) const {
  for (int e = 0; e < variables(); ++e) {
    const Edge& edge = edges_[e];
    const Eigen::Vector3d p = along_edge(edge, x);
    const double r = p.norm(), strain = r / edge.length - 1;
    const double stress = curve(edge).stress(strain, std::max(largest_[e], strain));
    add_pull(f, {edge.i, edge.j}, edge.width * (stress / r - slope_[e] / edge.length) * p);
  }
}

void CurvedTension::add_jacobian(const Vectors& x, const JacobianEntries& entries) const {
  for (int e = 0; e < variables(); ++e) {
    const Edge& edge = edges_[e];
    const Eigen::Vector3d p = along_edge(edge, x);
    const double r = p.norm(), strain = r / edge.length - 1, largest = std::max(largest_[e], strain);
    const double stress = curve(edge).stress(strain, largest), slope = curve(edge).slope(strain, largest);
    const Eigen::Vector3d n = p / r;
    const Eigen::Matrix3d nn = n * n.transpose();
    const double turn = entries.exact() ? stress : std::max(stress, 0.0);
    const EdgeEnds ends{edge.i, edge.j};
    add_edge_pair(entries.add_dx, ends, ends,
                  edge.width * (slope / edge.length * nn + turn / r * (Eigen::Matrix3d::Identity() - nn)));
  }
}

}  // namespace

/// Tension σ(ε) by measured curves with branches [Etzmuß 2002, 2.1.3], which take the place of k1 and k2.
std::optional<Term> make_curves(const Sheet& sheet) {
  const auto tension = std::make_shared<CurvedTension>(sheet);
  if (!tension->acts()) return {};
  Term term;
  term.memory = tension;
  term.without_energy = true;  // branches have one each, which depends on what is remembered
  term.springs = [=](const Vectors& x, Vectors& f) { tension->add_springs(x, f); };
  term.force = [=](const Configuration& c, Vectors& f) { tension->add_rest(c.x, f); };
  term.jacobian = [=](const Configuration& c, const JacobianEntries& entries) { tension->add_jacobian(c.x, entries); };
  return term;
}

}  // namespace drape::model
