#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drape::bench {

/// What a page in headless Chromium has shown.
struct Browsed {
  std::string seen;                  ///< the script's see(text)
  std::vector<std::string> console;  ///< all messages on the console, uncaught errors among them; those of the driver left out
};

/// How long a page may take before Chromium is ended [s]: three times what one of 42 figures took on a machine with other work.
inline constexpr double browsing_time = 300;

/// Loads an HTML file in a window of this size in pixels and runs a script in it once its figures are drawn (async code; it
/// calls see(text) at most once). Chromium is Debian's, found on PATH. Throws std::system_error: no such file (there is no
/// Chromium), timed out after browsing_time, interrupted.
Browsed browse(const std::filesystem::path& page, const std::string& script, int width);

}  // namespace drape::bench
