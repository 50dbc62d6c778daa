#pragma once

#include <memory>
#include <vector>

#include "model/memory/term_memory.hpp"
#include "solver/counters.hpp"

namespace drape::model {

/// The memories of all forces of a sheet, one after the other in z.
class ClothMemory final : public solver::Memory {
 public:
  explicit ClothMemory(solver::Counters& work);

  void add(std::shared_ptr<TermMemory> memory);

  int variables() const override { return variables_; }
  void begin(int order, double t, const solver::State& y) override;
  void pass(double t, const solver::State& y) override;
  void carry(double t, solver::State& y) override;
  void rate(const solver::State& y, Eigen::VectorXd& dz) const override;
  void respond(double gamma, const solver::State& y, const Eigen::VectorXd& r, solver::State& d) const override;
  void branches(const solver::State& y, std::vector<int>& now) const override;
  double first_kink(double h, double from, const solver::State& y0, const solver::State& y1) const override;
  std::int64_t stiffness_changes() const override;
  const solver::SparseMatrix& stiffness() override;
  double energy(const solver::State& y) const override;

  /// The part of K that never changes.
  void set_stiffness(const solver::SparseMatrix& constant) { constant_ = constant; }

 private:
  struct Part {
    std::shared_ptr<TermMemory> memory;
    int first;  ///< of its variables

    /// Its variables in z or in a change of z.
    template <class Vector>
    auto of(Vector& z) const {
      return z.segment(first, memory->variables());
    }
  };

  std::vector<Part> parts_;
  int variables_ = 0;
  solver::SparseMatrix constant_, stiffness_;
  std::int64_t changes_known_ = -1;  ///< to `stiffness_`
  std::int64_t& updates_;
};

}  // namespace drape::model
