#pragma once

#include <array>
#include <span>
#include <string_view>

namespace drape::solver {

/// A Rosenbrock method with one γ for all stages, and an embedded one of an order less with the weights b̂.
struct RosenbrockTableau {
  static constexpr int most = 4;  ///< stages
  using Row = std::array<double, most>;

  std::string_view name;
  int stages, order;
  bool w_method;  ///< whether it has this order with any matrix in the place of the Jacobian
  double gamma;   ///< γ_ii
  std::array<Row, most> a;
  std::array<Row, most> gammas;  ///< γ_ij below the diagonal
  Row b, b_hat;
};

/// All of them.
std::span<const RosenbrockTableau> rosenbrock_tableaus();

}  // namespace drape::solver
