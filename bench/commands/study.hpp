#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/commands/output.hpp"
#include "bench/commands/scene_choice.hpp"

namespace drape::bench {

/// What the subcommand study is told.
struct StudyArguments {
  std::string name;
  bool quick = false;
  std::vector<std::string> methods = {};  ///< by name; empty: the study's own
  SceneChoice choice;
  Output output;
};

/// Runs the study, prints what it finds, and returns the file that it is recorded in; or prints how much that would be, or what
/// is to be said about a shard of it. Throws std::invalid_argument if the arguments do not go together, and what
/// record_in_file() throws.
std::filesystem::path run_study(const StudyArguments& a);

}  // namespace drape::bench
