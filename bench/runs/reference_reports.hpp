#pragma once

#include <fmt/format.h>

#include <chrono>
#include <string>

namespace drape::bench {

/// Says how far a reference is, and when it has ended, if it takes long enough to be reported at all. `Line`: Progress or
/// Checkpoint.
template <class Line>
class ReferenceReports {
 public:
  ReferenceReports(Line& line, const std::string& scene) : line_(line), title_("reference of " + scene) { line.show(title_); }
  ~ReferenceReports() {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
    if (said_) line_.note(fmt::format("{}: ended after {:.0f} s", title_, elapsed.count()));
  }
  ReferenceReports(const ReferenceReports&) = delete;
  ReferenceReports& operator=(const ReferenceReports&) = delete;

  void operator()(const std::string& pace) {
    said_ = true;
    line_.report(title_ + ": " + pace);
  }

 private:
  Line& line_;
  std::string title_;
  bool said_ = false;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace drape::bench
