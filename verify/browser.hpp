#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drape::verify {

/// What a page in headless Chromium has shown.
struct Browsed {
  std::string seen;                  ///< what the script passed to see()
  std::vector<std::string> console;  ///< all messages on the console, uncaught errors among them; those of the driver left out
};

/// Loads an HTML file in a window of so many pixels and runs a script in it once its figures are drawn (async code; it calls
/// see(text) at most once). Throws std::system_error if there is no Chromium.
Browsed browse(const std::filesystem::path& page, const std::string& script, int width);

}  // namespace drape::verify
