#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace drape::bench {

/// What became of a script.
struct ScriptResult {
  bool success = false;
  std::string said;  ///< all that it has written; if it failed, why in one line
};

/// Runs a Python script, by its path in bench/.
ScriptResult run_script(std::string_view script, const std::vector<std::string>& arguments);

}  // namespace drape::bench
