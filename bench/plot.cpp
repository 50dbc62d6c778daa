#include "bench/plot.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "results/child.hpp"

namespace drape::bench {
namespace {

constexpr const char* interpreter = "/usr/bin/python3";  // Debian's own, which finds its matplotlib and h5py
constexpr double most_seconds = 600;

/// The last line of a text, which in a traceback says what happened.
std::string last_line(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace

std::string plot(std::string_view script, const std::filesystem::path& file) {
  try {
    const std::string path = fmt::format("{}/bench/{}", DRAPE_SOURCE_DIR, script);
    results::ChildSaid said = results::run_child({interpreter, path, file.string()}, most_seconds);
    if (said.exit_code == 0) return said.out + said.err;
    return fmt::format("no plots: {} said '{}'\n", script, last_line(std::move(said.err)));
  } catch (const std::system_error& error) {
    return fmt::format("no plots: {}\n", error.what());
  }
}

}  // namespace drape::bench
