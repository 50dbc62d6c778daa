#pragma once

#include "model/jacobian/slots.hpp"

namespace drape::model {

/// Assembles ∂f/∂x and ∂f/∂v from the terms' exact blocks straight into their sparse patterns, which are found once.
class ExactJacobian {
 public:
  /// `coordinates`: 3N.
  explicit ExactJacobian(int coordinates) : dx_(coordinates), dv_(coordinates) {}

  /// Sets both, 3N × 3N.
  void assemble(const VisitBlocks& visit, SparseMatrix& df_dx, SparseMatrix& df_dv);

 private:
  struct Part {
    SparseMatrix zero;  ///< the pattern
    BlockSlots slots;

    explicit Part(int coordinates) : zero(coordinates, coordinates) {}
    void analyse(const Blocks& blocks);
  };

  Part dx_, dv_;
  bool known_ = false;
};

}  // namespace drape::model
