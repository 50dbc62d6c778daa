#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <stdexcept>
#include <thread>
#include <vector>

#include "reference/cache.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify::reference_cache_test {
namespace {

using reference::Cache;
using reference::Reference;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
namespace fs = std::filesystem;

/// Numbers without a short decimal form, a negative zero and a subnormal one.
Reference some_reference() {
  const solver::Vectors x = solver::Vectors::Constant(4, 3, std::numbers::pi), v = -0.0 * x;
  return {.name = "cvode-bdf",
          .witness = "arkode-esdirk",
          .tolerance = 1e-10,
          .error = {1e-12 / 3, 5e-324},
          .growth = {0.3, 1e300},
          .trajectory = {{0.1, 0.2}, {{x, v}, {x * 7, x / 3}}},
          .witnessed = {{0.1, 0.2}, {{x / 13, v}, {x * 3, x / 7}}},
          .perturbed = {{0.1, 0.2}, {{x / 5, v}, {x * 7, x / 11}}}};
}

bool equal(const Reference& a, const Reference& b) {
  const auto same_bits = [](const solver::Vectors& p, const solver::Vectors& q) {
    return p.rows() == q.rows() && std::memcmp(p.data(), q.data(), static_cast<std::size_t>(p.size()) * sizeof(double)) == 0;
  };
  const auto same_state = [&](const solver::State& p, const solver::State& q) {
    return same_bits(p.x, q.x) && same_bits(p.v, q.v);
  };
  const auto same_trajectory = [&](const reference::Trajectory& p, const reference::Trajectory& q) {
    return p.times == q.times && std::ranges::equal(p.states, q.states, same_state);
  };
  return a.name == b.name && a.witness == b.witness && a.tolerance == b.tolerance && a.error == b.error &&
         a.growth == b.growth && same_trajectory(a.trajectory, b.trajectory) && same_trajectory(a.witnessed, b.witnessed) &&
         same_trajectory(a.perturbed, b.perturbed);
}

std::string read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write(const fs::path& path, std::string_view bytes) { std::ofstream(path, std::ios::binary) << bytes; }

class ReferenceCache : public testing::Test {
 protected:
  /// Asks a cache in `folder`, as a new process would.
  Reference ask(std::string_view key) {
    Cache cache(folder);
    Reference result = cached(cache, key, compute);
    counts = cache.counts();
    messages = cache.messages();
    return result;
  }

  const base::TemporaryFolder temporary;
  const fs::path folder = temporary / "made when needed";
  int computed = 0;
  const std::function<Reference()> compute = [this] { return ++computed, some_reference(); };
  Cache::Counts counts;
  std::vector<std::string> messages;
};

TEST_F(ReferenceCache, ComputesOnceAndReturnsTheSameBits) {
  EXPECT_TRUE(equal(ask("scene"), some_reference()));
  EXPECT_TRUE(equal(ask("scene"), some_reference()));
  EXPECT_EQ(computed, 1);
  EXPECT_EQ(counts.hits, 1);
  EXPECT_THAT(messages, IsEmpty());
}

TEST_F(ReferenceCache, ComputesForEveryOtherKey) {
  ask("scene");
  ask("scene ");
  EXPECT_EQ(computed, 2);
  EXPECT_EQ(counts.absent, 1);
}

TEST_F(ReferenceCache, HoldsAllThatAReferenceDependsOn) {
  ask("scene");
  const std::string file = read(Cache(folder).file("scene"));
  const auto key = file.find("scene\nSUNDIALS");  // before it are bytes that end a C string
  ASSERT_NE(key, std::string::npos);
  EXPECT_THAT(file.substr(key), testing::ContainsRegex("^scene\nSUNDIALS [0-9.]+, KLU [0-9.]+, Eigen [0-9.]+\n"
                                                       "sources [0-9a-f]{64}\nflags .*-O.*\n"
                                                       "predefined macros [0-9a-f]{64}\n"));
}

TEST_F(ReferenceCache, LeavesNothingButTheFilesOfItsKeys) {
  ask("scene");
  const std::vector<fs::path> files(fs::directory_iterator(folder), {});
  EXPECT_THAT(files, ElementsAre(Cache(folder).file("scene")));
}

TEST_F(ReferenceCache, RejectsAndReplacesAFileWithAnyByteChanged) {
  ask("scene");
  const fs::path path = Cache(folder).file("scene");
  const std::string good = read(path);
  for (std::size_t i = 0; i < good.size(); i += 7) {
    std::string bad = good;
    bad[i] ^= 0x10;
    write(path, bad);
    computed = 0;
    EXPECT_TRUE(equal(ask("scene"), some_reference()));
    ASSERT_EQ(computed, 1) << "byte " << i;
    ASSERT_EQ(counts.rejected, 1) << "byte " << i;
    ASSERT_EQ(read(path), good) << "byte " << i;
  }
  EXPECT_THAT(messages, ElementsAre(HasSubstr(path.string())));
}

TEST_F(ReferenceCache, RejectsAndReplacesATruncatedFile) {
  ask("scene");
  const fs::path path = Cache(folder).file("scene");
  const std::string good = read(path);
  for (std::size_t size : {std::size_t{0}, std::size_t{7}, std::size_t{20}, good.size() / 2, good.size() - 1}) {
    write(path, good.substr(0, size));
    computed = 0;
    ask("scene");
    EXPECT_EQ(computed, 1) << size;
    EXPECT_EQ(counts.rejected, 1) << size;
    EXPECT_EQ(read(path), good) << size;
  }
}

TEST_F(ReferenceCache, RejectsTheFileOfAnotherKeyUnderItsName) {
  ask("scene");
  fs::copy_file(Cache(folder).file("scene"), Cache(folder).file("other scene"));
  ask("other scene");
  EXPECT_EQ(computed, 2);
  EXPECT_EQ(counts.rejected, 1);
  EXPECT_THAT(messages, ElementsAre(HasSubstr("another key")));
}

TEST_F(ReferenceCache, ComputesWithoutKeepingIfTheFolderCannotBeWritten) {
  write(folder, "a file where the folder should be");
  EXPECT_TRUE(equal(ask("scene"), some_reference()));
  EXPECT_TRUE(equal(ask("scene"), some_reference()));
  EXPECT_EQ(computed, 2);
  EXPECT_EQ(counts.not_stored, 1);
  EXPECT_THAT(messages, ElementsAre(HasSubstr("not kept")));
}

TEST_F(ReferenceCache, ComputesWithoutKeepingIfThereIsNoFolder) {
  Cache nowhere{fs::path()};
  EXPECT_TRUE(equal(cached(nowhere, "scene", compute), some_reference()));
  EXPECT_THAT(nowhere.messages(), ElementsAre(HasSubstr("DRAPE_CACHE")));
}

TEST_F(ReferenceCache, KeepsNothingOfAFailedComputation) {
  Cache cache(folder);
  EXPECT_THROW(cached(cache, "scene", []() -> Reference { throw reference::ReferenceError("no", "CV_CONV_FAILURE", 0); }),
               reference::ReferenceError);
  ask("scene");
  EXPECT_EQ(computed, 1);
}

TEST_F(ReferenceCache, OfProcessesThatNeedTheSameOneComputesIt) {
  std::atomic<int> computed_by_all = 0, asked = 0;
  const auto slowly = [&] {
    ++computed_by_all;
    std::this_thread::sleep_for(std::chrono::milliseconds(250));
    return some_reference();
  };
  std::vector<std::thread> threads;
  for (int k = 0; k < 3; ++k)
    threads.emplace_back([&] {
      Cache cache(folder);
      EXPECT_TRUE(equal(cached(cache, "scene", slowly, {}, [&] { ++asked; }), some_reference()));
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(computed_by_all, 1);
  EXPECT_GE(asked, 2);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1) << "the lock is gone";
}

TEST_F(ReferenceCache, WaitsNoLongerThanItsCallerLikes) {
  Cache cache(folder);
  const auto lock = cache.lock("scene");
  EXPECT_THROW(cached(cache, "scene", compute, {}, [] { throw std::runtime_error("enough"); }), std::runtime_error);
  EXPECT_EQ(computed, 0);
  cached(cache, "another scene", compute);
  EXPECT_EQ(computed, 1);
}

TEST(CacheKey, DependsOnEverythingTheCallerChooses) {
  const std::vector<double> times{0.5, 1}, other_times{0.5, std::nextafter(1, 2)};
  const std::string key = reference::cache_key("[scene]", 0, times, {});
  EXPECT_EQ(key, reference::cache_key("[scene]", 0, times, {}));
  EXPECT_NE(key, reference::cache_key("[scena]", 0, times, {}));
  EXPECT_NE(key, reference::cache_key("[scene]", 1e-300, times, {}));
  EXPECT_NE(key, reference::cache_key("[scene]", 0, other_times, {}));
  EXPECT_NE(key, reference::cache_key("[scene]", 0, times, {.rtol = 1e-9}));
  EXPECT_NE(key, reference::cache_key("[scene]", 0, times, {.size = 2}));
}

/// An environment variable, set as long as this lives.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    setenv(name, value, 1);
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;
  ~Variable() { old_ ? setenv(name_, old_->c_str(), 1) : unsetenv(name_); }

 private:
  const char* name_;
  std::optional<std::string> old_;
};

TEST(CacheFolder, IsTheFirstThatTheEnvironmentNames) {
  const auto folder = [](const char* drape, const char* xdg, const char* home) {
    const Variable a("DRAPE_CACHE", drape), b("XDG_CACHE_HOME", xdg), c("HOME", home);
    return reference::default_cache_folder();
  };
  EXPECT_EQ(folder("/a", "/b", "/c"), "/a");
  EXPECT_EQ(folder("", "/b", "/c"), "/b/drape");
  EXPECT_EQ(folder("", "", "/c"), "/c/.cache/drape");
  EXPECT_EQ(folder("", "", ""), "");
}

}  // namespace
}  // namespace drape::verify::reference_cache_test
