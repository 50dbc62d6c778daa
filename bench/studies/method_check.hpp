#pragma once

#include <string>
#include <vector>

#include "bench/studies/studies.hpp"

namespace drape::bench {

/// What is measured of a method, with stage and linear solvers in its name or without, each in a table of its own:
/// - `check-order`: errors with ever smaller steps on a soft sheet, and the order beside the declared one
/// - `check-stability`: the largest usable steps on a sheet hung by two corners, strongly and weakly damped, beside linear
/// theory
/// - `check-energy`: what it makes of the energy of an undamped sheet
/// - `check-cost`: time and evaluations of forces at equal errors, beside usual methods
std::vector<TableJob> check_jobs(const std::string& method);

}  // namespace drape::bench
