// Programs that are run for us: what they say, and what becomes of those that do not end.

#include "solver/base/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <system_error>

namespace drape::verify::child_test {
namespace {

/// How running a program fails; 0 if it does not.
std::error_code failure(const std::vector<std::string>& words, double seconds) {
  try {
    base::run_child(words, seconds);
    return {};
  } catch (const std::system_error& error) {
    return error.code();
  }
}

TEST(Child, SaysWhatItSaidAndHowItEnded) {
  const base::ChildSaid said = base::run_child({"sh", "-c", "echo out; echo err >&2; exit 3"}, 60);
  EXPECT_EQ(said.out, "out\n");
  EXPECT_EQ(said.err, "err\n");
  EXPECT_EQ(said.exit_code, 3);
  EXPECT_EQ(base::run_child({"sh", "-c", "kill -TERM $$"}, 60).exit_code, 128 + 15);
}

TEST(Child, ThatDoesNotEndIsKilledWithWhatItStarted) {
  EXPECT_EQ(failure({"sh", "-c", "sleep 600 & wait"}, 0.1), std::errc::timed_out);
}

TEST(Child, ThatIsNotThereIsMissed) { EXPECT_EQ(failure({"no-such-program"}, 60), std::errc::no_such_file_or_directory); }

}  // namespace
}  // namespace drape::verify::child_test
