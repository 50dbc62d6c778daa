#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace drape::bench {

/// A script by which bash completes commands, options, and the names that they take, from the tables that help shows.
std::string bash_completion(const CLI::App& app);

}  // namespace drape::bench
