#pragma once

#include <chrono>
#include <string>

namespace drape::bench {

/// A line on the terminal with the part done and the time left. If standard error is not a terminal, it gets only reports and
/// notes.
class Progress {
 public:
  explicit Progress(int total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// What is being done now.
  void show(const std::string& activity);

  /// What is being done now and takes long: where there is no terminal, a line of its own at most every five seconds.
  void report(const std::string& activity);

  /// A line that stays.
  void note(const std::string& line);

  /// One of the total is done.
  void advance();

 private:
  void draw() const;

  bool terminal_;
  int total_, done_ = 0;
  int known_ = 0;  ///< of those that are done: they took no time, since an earlier process has done them
  std::string activity_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), last_ = start_;
  std::chrono::steady_clock::time_point reported_ = start_ - std::chrono::hours(1);
};

}  // namespace drape::bench
