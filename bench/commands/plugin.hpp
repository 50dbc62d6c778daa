#pragma once

#include <string>

namespace drape::bench {

/// Loads a plugin (solver/plugin.hpp) and adds its methods and forces to the tables. Throws std::invalid_argument, naming the
/// file, if it cannot be loaded or was built otherwise than this program.
void load_plugin(const std::string& file);

}  // namespace drape::bench
