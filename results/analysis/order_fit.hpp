#pragma once

#include <optional>
#include <span>
#include <string>

#include "results/table_builder.hpp"

namespace drape::results {

/// The order of convergence of a series of errors.
struct OrderFit {
  double order;            ///< slope of log error against log h, by least squares
  double lowest, highest;  ///< between neighbours
  int first, last;         ///< the window: places in the series
};

/// Finds the order where it is to be seen. Errors below ten times their uncertainty are left out; among the rest the longest
/// window of at least four neighbours (three refinements) is taken in which the order between neighbours varies by at most
/// 0.1, the finest of equally long ones: so it avoids the pre-asymptotic and the round-off end by itself, and it does not know
/// what order is hoped for. Nothing if there is no such window. `h` falls; errors that are not finite are left out.
std::optional<OrderFit> fit_order(std::span<const double> h, std::span<const double> errors, double uncertainty);

/// "2 as declared", or how it is not: within ±0.1.
std::string verdict(const std::optional<OrderFit>& fit, double declared);

/// The columns of a fit and its verdict, in the current row.
void add_fit(TableBuilder& table, const std::optional<OrderFit>& fit, const std::string& verdict);

}  // namespace drape::results
