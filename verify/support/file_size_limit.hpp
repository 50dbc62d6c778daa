#pragma once

#include <csignal>

#include "verify/support/resource_limit.hpp"

namespace drape::verify {

/// Files cannot become longer than this, as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : signal_(std::signal(SIGXFSZ, SIG_IGN)), limit_(RLIMIT_FSIZE, bytes) {}
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() { std::signal(SIGXFSZ, signal_); }

 private:
  void (*signal_)(int);
  ResourceLimit limit_;
};

}  // namespace drape::verify
