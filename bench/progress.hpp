#pragma once

#include <chrono>
#include <string>

namespace drape::bench {

/// A line on the terminal with the part done and the time left. Writes nothing if standard error is not a terminal.
class Progress {
 public:
  explicit Progress(int total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// What is being done now.
  void show(const std::string& activity);

  /// One of the total is done.
  void advance();

 private:
  void draw() const;

  bool terminal_;
  int total_, done_ = 0;
  int known_ = 0;  ///< of those that are done: they took no time, since an earlier process has done them
  std::string activity_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), last_ = start_;
};

}  // namespace drape::bench
