#pragma once

#include <memory>
#include <vector>

#include "model/forces/term.hpp"
#include "model/memory/stress_law.hpp"
#include "model/sheet/strain.hpp"

namespace drape::model {

/// Forces −A σ ∂ε/∂x of strains by laws with memory.
class RememberedStresses final : public TermMemory {
 public:
  /// `stiff`, of an edge: K takes the slope C of its branch, C w/l (x_j − x_i), and the remainder is explicit.
  void add(const Strain& strain, std::shared_ptr<const StressLaw> law, bool stiff = false);

  bool empty() const { return elements_.empty(); }

  /// Both parts, for the term.
  void add_springs(const Vectors& x, Vectors& f) const;
  void add_rest(const Vectors& x, Vectors& f) const;
  void add_jacobian(const Configuration& c, const JacobianEntries& entries) const;

  int variables() const override { return static_cast<int>(elements_.size()); }
  void begin(int, double, const solver::State& y, const Variables& z) override { pass(0, y, z); }
  void pass(double, const solver::State& y, const Variables& z) override;
  void carry(double, const solver::State& y, MutableVariables z) override;
  void rate(const solver::State& y, const Variables& z, MutableVariables dz) const override;
  void respond(double gamma, const solver::State& y, const Variables& r, const solver::State& d,
               MutableVariables dz) const override;
  double energy(const solver::State& y, const Variables& z) const override;
  void add_branches(const solver::State& y, const Variables& z, std::vector<int>& now) const override;
  double first_kink(double h, double from, const solver::State& y0, const Variables& z, const solver::State& y1) const override;
  std::int64_t stiffness_changes() const override { return changes_; }
  void add_stiffness(std::vector<Eigen::Triplet<double>>& entries) const override;

 private:
  struct Element {
    Strain strain;
    std::shared_ptr<const StressLaw> law;
    bool stiff;
    double from = 0, z = 0;  ///< where the motion has passed last
    double slope = 0;        ///< in K [N/m]

    Stress stress(double strain_now) const { return law->stress(strain_now, from, z); }
    double spring() const;  ///< [N/m]
  };

  std::vector<Element> elements_;
  std::int64_t changes_ = 0;
};

/// Adds all quadrants of a grid by a law, and all particles by laws of their curvature along weft and warp, where there are
/// any.
void add_shear(const Grid& grid, const std::shared_ptr<const StressLaw>& law, RememberedStresses& stresses);
void add_bending(const Grid& grid, const std::shared_ptr<const StressLaw>& weft, const std::shared_ptr<const StressLaw>& warp,
                 RememberedStresses& stresses);

/// The term of these; nothing if there are none.
std::optional<Term> remembering_term(const std::shared_ptr<RememberedStresses>& stresses);

}  // namespace drape::model
