#include "bench/runs/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "bench/runs/verbosity.hpp"
#include "solver/base/printable.hpp"
#include "solver/base/terminal.hpp"

namespace drape::bench {
Progress::Progress(int total) : terminal_(isatty(STDERR_FILENO) == 1 && verbosity() != Verbosity::quiet), total_(total) {}

Progress::~Progress() {
  if (terminal_) fmt::print(stderr, "\r\033[K");
}

void Progress::show(const std::string& activity) {
  activity_ = base::printable(activity);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  if (verbosity() == Verbosity::verbose) return note(fmt::format("{:8.1f} s  {}", elapsed.count(), activity_));
  draw();
}

void Progress::report(const std::string& activity) {
  if (terminal_) {
    activity_ = base::printable(activity);
    return draw();
  }
  const auto now = std::chrono::steady_clock::now();
  if (now - reported_ < std::chrono::seconds(5)) return;
  reported_ = now;
  note(activity);
}

void Progress::note(const std::string& line) {
  if (verbosity() == Verbosity::quiet) return;
  fmt::print(stderr, "{}{}\n", terminal_ ? "\r\033[K" : "", line);
  std::fflush(stderr);
  draw();
}

void Progress::advance() {
  const auto now = std::chrono::steady_clock::now();
  if (now - std::exchange(last_, now) < std::chrono::milliseconds(1)) ++known_;
  ++done_;
  draw();
}

void Progress::draw() const {
  if (!terminal_) return;
  constexpr int width = 24;
  const int filled = width * done_ / std::max(total_, 1);
  std::string left = "estimating";
  if (done_ > known_ || done_ == total_) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    const long seconds = std::lround(elapsed.count() / std::max(done_ - known_, 1) * (total_ - done_));
    left = fmt::format("{}:{:02} left", seconds / 60, seconds % 60);
  }
  const std::string line =
      fmt::format("[{:=<{}}{:{}}] {}/{}  {}  {}", "", filled, "", width - filled, done_, total_, left, activity_);
  fmt::print(stderr, "\r\033[K{:.{}}", line, base::columns_of(STDERR_FILENO) - 1);  // a line that wraps could not be drawn over
  std::fflush(stderr);
}

}  // namespace drape::bench
