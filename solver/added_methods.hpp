#pragma once

#include <span>

#include "solver/methods.hpp"

namespace drape::solver {

/// Adds rows to the table of methods for as long as the program runs; what they point to must stay. To be called before methods
/// are used. Throws std::invalid_argument, naming it, if a name is taken or not one for command lines, or if there are too
/// many.
void add_methods(std::span<const Method> rows);

}  // namespace drape::solver
