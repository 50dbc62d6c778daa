// Provenance tells what this program really is: compared with what the compiler and the libraries say themselves.

#include "results/provenance.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <Eigen/Core>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <thread>

#include "verify/support/temporary_folder.hpp"

namespace drape::verify::results_provenance_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::MatchesRegex;

std::map<std::string, std::string> facts() {
  std::map<std::string, std::string> values;
  for (const auto& [name, value, description] : results::provenance("bench --all")) values[name] = value;
  return values;
}

TEST(Provenance, KnowsAndExplainsAllItLists) {
  for (const auto& [name, value, description] : results::provenance("bench --all")) {
    EXPECT_NE(value, "") << name;
    EXPECT_NE(description, "") << name;
  }
}

TEST(Provenance, AgreesWithTheCompiler) {
  EXPECT_THAT(facts().at("compiler"), HasSubstr(fmt::format("{}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__)));
  EXPECT_THAT(facts().at("compile_flags"), MatchesRegex("-std=.* -O[0-3g].* -fno-math-errno.*"));
#ifdef DRAPE_SANITIZE
  EXPECT_EQ(facts().at("sanitizers"), "address,undefined");
  EXPECT_THAT(facts().at("compile_flags"), HasSubstr("-fsanitize=address,undefined"));
#else
  EXPECT_EQ(facts().at("sanitizers"), "none");
  EXPECT_THAT(facts().at("compile_flags"), testing::Not(HasSubstr("-fsanitize")));
#endif
}

TEST(Provenance, SaysNativeJustIfTheFlagsDo) {
  const bool flag = facts().at("compile_flags").find("-march=native") != std::string::npos;
  EXPECT_EQ(facts().at("native"), flag ? "yes" : "no");
}

TEST(Provenance, AgreesWithTheLibraries) {
  EXPECT_EQ(facts().at("eigen"), fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION));
  EXPECT_EQ(facts().at("fmt"), fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100));
  for (const char* library : {"sundials", "cholmod", "hdf5", "google_benchmark", "cli11", "tomlplusplus", "assimp"})
    EXPECT_THAT(facts().at(library), MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+")) << library;
}

TEST(Provenance, DescribesThisProcess) {
  EXPECT_EQ(facts().at("command_line"), "bench --all");
  EXPECT_EQ(facts().at("cores"), std::to_string(std::thread::hardware_concurrency()));
  EXPECT_THAT(facts().at("host_os"), HasSubstr("Linux"));
  EXPECT_THAT(facts().at("started"), MatchesRegex("20..-..-..T..:..:..Z"));
}

// --- The commit, looked up by the script that every build runs ------------------------------------------------------------

void run(const std::string& command) { ASSERT_EQ(std::system((command + " >/dev/null 2>&1").c_str()), 0) << command; }

class GitCommit : public testing::Test {
 protected:
  void git(const std::string& arguments) const {
    run(fmt::format("git -C '{}' -c user.name=test -c user.email=test {}", folder_.path().string(), arguments));
  }
  void write_source(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }

  void commit_a_source() const {
    git("init");
    write_source("a.cpp", "int a;");
    git("add a.cpp");
    git("commit -m first");
  }

  /// The row that the build includes.
  std::string row() const {
    const fs::path script = fs::path(DRAPE_SOURCE_DIR) / "results/provenance.cmake";
    run(fmt::format("cmake -D SOURCE_DIR='{}' -D OUTPUT='{}' -P '{}'", folder_.path().string(), output().string(),
                    script.string()));
    std::ifstream in(output());
    std::string line;
    std::getline(in, line);
    return line;
  }
  fs::path output() const { return output_folder_ / "git_commit.inc"; }

 private:
  base::TemporaryFolder folder_;
  base::TemporaryFolder output_folder_;
};

TEST_F(GitCommit, IsUnknownOutsideGit) { EXPECT_THAT(row(), HasSubstr("\"unknown\"")); }

TEST_F(GitCommit, IsTheHashOfCleanSources) {
  commit_a_source();
  EXPECT_THAT(row(), MatchesRegex(".\"git_commit\", \"[0-9a-f]{40}\", .*"));
}

TEST_F(GitCommit, SaysThatASourceWasChanged) {
  commit_a_source();
  write_source("a.cpp", "int b;");
  EXPECT_THAT(row(), MatchesRegex(".*\"[0-9a-f]{40}-dirty\".*"));
}

TEST_F(GitCommit, SaysThatASourceIsNew) {
  commit_a_source();
  write_source("b.cpp", "int b;");
  EXPECT_THAT(row(), MatchesRegex(".*\"[0-9a-f]{40}-dirty\".*"));
}

TEST_F(GitCommit, DoesNotCauseARebuildWithoutChange) {
  commit_a_source();
  const std::string before = row();
  const fs::file_time_type long_ago{};
  fs::last_write_time(output(), long_ago);
  EXPECT_EQ(row(), before);
  EXPECT_EQ(fs::last_write_time(output()), long_ago);
  write_source("a.cpp", "int b;");
  EXPECT_NE(row(), before);
  EXPECT_NE(fs::last_write_time(output()), long_ago);
}

}  // namespace
}  // namespace drape::verify::results_provenance_test
