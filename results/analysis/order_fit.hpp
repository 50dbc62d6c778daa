#pragma once

#include <optional>
#include <span>
#include <string>

#include "results/columns.hpp"

namespace drape::results {

/// The order of convergence of a series of errors.
struct OrderFit {
  double order;            ///< slope of log error against log h, by least squares
  double lowest, highest;  ///< between neighbours
  int first, last;         ///< the window: places in the series
};

/// "1.987 … 2.013"
std::string spread(const OrderFit& fit);

/// Finds the order where it is to be seen. Errors below ten times their uncertainty are left out; among the rest the longest
/// window of at least four neighbours (three refinements) is taken in which the order between neighbours varies by at most
/// 0.1, the finest of equally long ones: so it avoids the pre-asymptotic and the round-off end by itself, and it does not know
/// what order is hoped for. Nothing if there is no such window. `h` falls; errors that are not finite are left out.
std::optional<OrderFit> fit_order(std::span<const double> h, std::span<const double> errors, double uncertainty);

/// Met if within ±0.1 of what is declared; open without a fit.
Verdict order_verdict(const std::optional<OrderFit>& fit, double declared);

/// What a curve comes to: the first row of it has this.
struct FittedCurve {
  std::optional<OrderFit> fit;
  std::optional<Verdict> verdict;  ///< nothing where no order is declared
};

inline constexpr ColumnOf<FittedCurve> fit_columns[] = {
    {"verdict", "verdict", "", "whether the order is the declared one", Role::verdict, field<&FittedCurve::verdict>},
    {"fitted_order", "fitted", "1", "order by least squares over the window that the program found", Role::order,
     [](const FittedCurve& curve) { return curve.fit ? Datum(curve.fit->order) : Datum(); }},
    {"spread", "between", "", "lowest and highest order between neighbours in the window", Role::note,
     [](const FittedCurve& curve) { return curve.fit ? Datum(spread(*curve.fit)) : Datum(); }},
};

}  // namespace drape::results
