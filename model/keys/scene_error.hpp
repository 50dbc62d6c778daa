#pragma once

#include <stdexcept>

namespace drape::model {

/// A scene that cannot be read: one sentence with the file, line, key and what would be right.
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace drape::model
