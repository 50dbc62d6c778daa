#pragma once

#include <span>
#include <string>

#include "model/forces/term.hpp"

namespace drape::model {

/// Adds rows to the table of forces, and keys forces.FORCE.PARAMETER to those of scenes, for as long as the program runs; what
/// the rows point to must stay. A scene has such a force if it has one of these keys. `code`: hash of what computes them. To be
/// called before scenes are read. Throws std::invalid_argument, naming the force, if a name is taken or not one for scene
/// files, or if a row is not complete.
void add_forces(std::span<const TermKind> rows, const std::string& code);

}  // namespace drape::model
