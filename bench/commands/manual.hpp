#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace drape::bench {

/// The manual page: what help says of all commands, and the names that they take, as man reads it.
std::string manual(const CLI::App& app);

}  // namespace drape::bench
