#include "bench/commands/plot.hpp"

#include <fmt/format.h>

#include "bench/score/script.hpp"

namespace drape::bench {

std::string plot(std::string_view script, const std::filesystem::path& file) {
  const ScriptResult result = run_script(script, {file.string()});
  return result.success ? result.said : fmt::format("no plots: {} said '{}'\n", script, result.said);
}

}  // namespace drape::bench
