#pragma once

#include <fstream>
#include <string>

#include "model/keys/scene_error.hpp"
#include "model/pattern/sewn_pattern.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify {

/// The pattern of a file with this name and text.
inline model::SewingPattern pattern_of(const std::string& name, const std::string& text) {
  const TemporaryFolder folder;
  const auto file = folder.path() / name;
  std::ofstream(file) << text;
  return model::read_pattern(file.string());
}

/// What is said of it when it is sewn; "no error" if nothing is wrong.
inline std::string pattern_error(const std::string& name, const std::string& text) {
  try {
    model::sew(pattern_of(name, text), 0.1);
  } catch (const model::SceneError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace drape::verify
