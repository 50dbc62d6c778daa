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

TEST(Child, SaysInOneLineWhyItFailed) {
  const auto failure_of = [](const char* script) { return base::run_child({"sh", "-c", script}, 60).failure(); };
  EXPECT_EQ(failure_of("echo fine >&2"), "");
  EXPECT_EQ(failure_of("echo first >&2; printf 'last\n\n' >&2; exit 1"), "last");
  EXPECT_EQ(failure_of("printf 'only' >&2; exit 1"), "only");
  EXPECT_EQ(failure_of("exit 1"), "");
  EXPECT_EQ(failure_of("echo ignored >&2; kill -TERM $$"), "ended by signal 15");
}

TEST(PeakMemory, HasWhatWasTakenInMegabytes) {
  constexpr std::size_t taken = 300;
  EXPECT_EQ(std::vector<char>(taken << 20, 1).back(), 1);
  EXPECT_GE(base::peak_memory(), taken);
  EXPECT_LT(base::peak_memory(), 100'000) << "other tests take less";
}

TEST(Child, ThatDoesNotEndIsKilledWithWhatItStarted) {
  EXPECT_EQ(failure({"sh", "-c", "sleep 600 & wait"}, 0.1), std::errc::timed_out);
}

TEST(Child, ThatIsNotThereIsMissed) { EXPECT_EQ(failure({"no-such-program"}, 60), std::errc::no_such_file_or_directory); }

}  // namespace
}  // namespace drape::verify::child_test
