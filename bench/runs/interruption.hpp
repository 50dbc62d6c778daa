#pragma once

#include <filesystem>

namespace drape::bench {

/// Ends a sweep that SIGINT or SIGTERM has asked to end; what is finished is recorded. No std::exception, so that it does not
/// pass for the failure of a run.
struct Interrupted {
  int signal;
  std::filesystem::path out = {};  ///< the file of the sweep; empty if nothing is recorded in it
};

/// From now on SIGINT and SIGTERM are only noted, except a second one, which kills.
void note_interruptions();

/// Those noted so far count no more: for programs that go on after one.
void forget_interruptions();

/// Throws Interrupted if there was one.
void check_interruption();

}  // namespace drape::bench
