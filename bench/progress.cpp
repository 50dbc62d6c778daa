#include "bench/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace drape::bench {

Progress::Progress(int total) : terminal_(isatty(STDERR_FILENO) == 1), total_(total) {}

Progress::~Progress() {
  if (terminal_) fmt::print(stderr, "\r\033[K");
}

void Progress::show(const std::string& activity) {
  activity_ = activity;
  draw();
}

void Progress::advance() {
  ++done_;
  draw();
}

void Progress::draw() const {
  if (!terminal_) return;
  constexpr int width = 24;
  const int filled = width * done_ / std::max(total_, 1);
  std::string left = "estimating";
  if (done_ > 0) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    const int seconds = static_cast<int>(elapsed.count() / done_ * (total_ - done_) + 0.5);
    left = fmt::format("{}:{:02} left", seconds / 60, seconds % 60);
  }
  fmt::print(stderr, "\r\033[K[{:=<{}}{:{}}] {}/{}  {}  {}", "", filled, "", width - filled, done_, total_, left, activity_);
  std::fflush(stderr);
}

}  // namespace drape::bench
