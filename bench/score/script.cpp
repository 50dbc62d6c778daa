#include "bench/score/script.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "solver/base/process.hpp"

namespace drape::bench {
namespace {

constexpr const char* interpreter = "/usr/bin/python3";  // Debian's own, which finds its packages
constexpr double most_seconds = 600;

/// The last line of a text, which in a traceback says what happened.
std::string last_line(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace

ScriptResult run_script(std::string_view script, const std::vector<std::string>& arguments) {
  std::vector<std::string> words{interpreter, fmt::format("{}/bench/{}", DRAPE_SOURCE_DIR, script)};
  words.insert(words.end(), arguments.begin(), arguments.end());
  try {
    base::ChildSaid said = base::run_child(std::move(words), most_seconds);
    if (said.exit_code == 0) return {true, said.out + said.err};
    if (said.exit_code > 128) return {false, fmt::format("{} was ended by signal {}", script, said.exit_code - 128)};
    return {false, last_line(std::move(said.err))};
  } catch (const std::system_error& error) {
    return {false, error.what()};
  }
}

}  // namespace drape::bench
