// HDF5 files whose bytes or values are altered at random and sealed again: every reader ends well.
// --gtest_filter='FuzzHdf5.*'
// --gtest_repeat=100 goes on with others.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstring>
#include <random>

#include "results/analysis/compare.hpp"
#include "results/analysis/inspect.hpp"
#include "results/analysis/overview.hpp"
#include "results/file/hdf5.hpp"
#include "results/file/motion_file.hpp"
#include "results/file/run_file.hpp"
#include "results/file/validate.hpp"
#include "verify/support/limited_program.hpp"

namespace drape::verify::fuzz_hdf5_test {
namespace {

namespace fs = std::filesystem;
namespace hdf5 = results::hdf5;
using Bytes = std::vector<std::byte>;
using Random = std::mt19937_64;

#ifdef DRAPE_SANITIZE
constexpr int files = 3;  // sanitizers make them ten times slower
#else
constexpr int files = 12;
#endif

const fs::path data = fs::path(DRAPE_SOURCE_DIR) / "verify/data";

/// Numbers that lengths, addresses and counts should not be.
std::uint64_t unlikely(std::size_t size, Random& random) {
  switch (random() % 6) {
    case 0: return 0;
    case 1: return ~std::uint64_t{0};
    case 2: return random() % size;  // an address in the file
    case 3: return std::uint64_t{1} << random() % 64;
    case 4: return random();
    default: return (std::uint64_t{1} << random() % 64) - 1;
  }
}

/// Some bits, bytes, numbers or pieces are others.
Bytes altered(Bytes bytes, Random& random) {
  for (auto changes = 1 + random() % 4; changes > 0; --changes) {
    const std::size_t p = random() % (bytes.size() - 64), q = random() % (bytes.size() - 64);
    const std::uint64_t number = unlikely(bytes.size(), random);
    switch (random() % 5) {
      case 0: bytes[p] ^= std::byte{1} << random() % 8; break;
      case 1: bytes[p] = static_cast<std::byte>(random()); break;
      case 2: std::memcpy(&bytes[p], &number, std::size_t{1} << random() % 4); break;
      case 3: std::memmove(&bytes[p], &bytes[q], random() % 64); break;
      default: std::memcpy(&bytes[p / 8 * 8], &number, 8); break;
    }
  }
  return bytes;
}

// --- Values --------------------------------------------------------------------------------------------------------------

const std::vector<double> odd_numbers{NAN, INFINITY, -INFINITY, -1, 0, 1e308, 5e-324, 2e9, -3e9, 1e19};
const std::vector<std::string> odd_texts{"",          "\n",     "a = ", "[[[[[[", "\xff\xfe", "%s%n{}", std::string(5000, 'x'),
                                         "</script>", "success"};

template <class List>
auto one_of(const List& list, Random& random) {
  return list[random() % list.size()];
}

/// Another dataset in its place, of any type, shape and content.
void replace_dataset(const hdf5::Handle& file, const std::string& path, const hdf5::Item& item, Random& random) {
  std::vector<std::uint64_t> shape = item.shape;
  if (random() % 3 == 0) shape.resize(random() % 4, 1 + random() % 3);
  if (random() % 3 == 0 && !shape.empty()) shape[random() % shape.size()] = random() % 7;
  std::size_t count = 1;
  for (const std::uint64_t extent : shape) count *= extent;
  hdf5::remove(file, path);
  std::vector<double> numbers(count);
  for (double& number : numbers)
    number = random() % 2 == 0 ? one_of(odd_numbers, random) : static_cast<double>(random() % 1000);
  std::vector<std::int64_t> counts(count, static_cast<std::int64_t>(unlikely(1000, random)));
  std::vector<int> small(count, static_cast<int>(unlikely(1000, random)));
  const std::string type =
      random() % 4 == 0 ? one_of(std::vector<std::string>{"text", "float64", "int32", "int64"}, random) : item.type;
  if (type == "text") return hdf5::write_texts(file, path, std::vector<std::string>(count, one_of(odd_texts, random)), "");
  if (type == "int32") return hdf5::write_numbers(file, path, small.data(), shape, item.unit, "");
  if (type == "int64") return hdf5::write_numbers(file, path, counts.data(), shape, item.unit, "");
  hdf5::write_numbers(file, path, numbers.data(), shape, item.unit, "");
}

/// Some datasets and texts are others, or gone.
Bytes with_other_values(const Bytes& sealed, Random& random) {
  const hdf5::Handle file = hdf5::open_image(sealed);
  for (auto changes = 1 + random() % 3; changes > 0; --changes) {
    const auto all = hdf5::inventory(file);
    const auto& [path, item] = *std::next(all.begin(), static_cast<std::ptrdiff_t>(random() % all.size()));
    const auto at = path.find('@');
    if (at == std::string::npos && random() % 8 == 0)
      hdf5::remove(file, path);
    else if (at == std::string::npos && item.type != "group")
      replace_dataset(file, path, item, random);
    else if (at != std::string::npos && item.type == "text" && item.unit.empty() && all.contains(path.substr(0, at)) &&
             all.at(path.substr(0, at)).type == "group")
      hdf5::rewrite_text(hdf5::open_group(file, path.substr(0, at)), path.substr(at + 1), one_of(odd_texts, random));
  }
  return hdf5::image(file);
}

// --- What reads them -----------------------------------------------------------------------------------------------------

class FuzzHdf5 : public testing::Test {
 protected:
  /// Alters a file some times, in bytes or values, and lets the program read it in all ways.
  void try_all(const Bytes& good, const std::string& name) {
    const Bytes content(good.begin(), good.end() - static_cast<std::ptrdiff_t>(hdf5::sealed({}).size()));
    publish("good.h5", good);
    for (int k = 0; k < files && !HasFailure(); ++k) {
      const bool values = k % 3 == 0;
      publish("a.h5", values ? with_other_values(good, random) : hdf5::sealed(altered(content, random)));
      for (const Words& words : {Words{"report", "a.h5", "--out", "page"}, Words{"compare", "good.h5", "a.h5"},
                                 Words{"inspect", "a.h5", "--run", "0"}, Words{"inspect", "a.h5", "--validate"}})
        ++ended[run_limited(program, words).exit_code];
      keep_if_failed(fmt::format("{}-{}", name, k));
    }
    for (const auto& [code, count] : ended) RecordProperty(fmt::format("exit_code_{}", code), count);
  }

  void publish(const std::string& name, const Bytes& bytes) const {
    base::publish(program.folder() / name, bytes, base::Existing::replace);
  }

  /// The file by which a failure can be seen again.
  void keep_if_failed(const std::string& name) const {
    if (!HasFailure()) return;
    const fs::path kept = fs::temp_directory_path() / fmt::format("drape-fuzz-{}.h5", name);
    fs::copy_file(program.folder() / "a.h5", kept, fs::copy_options::overwrite_existing);
    ADD_FAILURE() << "by " << kept;
  }

  BenchIntegrators program;
  /// One for each test, which its repetitions go on with: no test depends on those before it.
  static Random& random_of_test() {
    static std::map<std::string, Random> all;
    return all.try_emplace(testing::UnitTest::GetInstance()->current_test_info()->name(), 1).first->second;
  }

  Random& random = random_of_test();
  std::map<int, int> ended;
  int stopped = 0;  ///< processes of their own, by a signal or limit
};

TEST_F(FuzzHdf5, Runs) { try_all(content_of(data / "runs-schema-4.h5"), "runs"); }

TEST_F(FuzzHdf5, Tables) { try_all(content_of(data / "tables-schema-4.h5"), "tables"); }

TEST_F(FuzzHdf5, Trajectories) {
  program.output({"run", "--scene", "box_swing", "--set", "grid.n=4", "--until", "0.04", "--no-reference", "--method",
                  "bdf2,midpoint", "--step", "0.01", "--repeat", "2", "--trajectory", "every=0.01", "--out", "moving.h5"});
  try_all(content_of(program.folder() / "moving.h5"), "trajectories");
}

/// What the program does with them, where a crash ends the test.
TEST_F(FuzzHdf5, RecordsInThisProcess) {
  for (const char* name : {"runs-schema-4.h5", "tables-schema-4.h5"}) {
    const Bytes good = content_of(data / name);
    const Bytes content(good.begin(), good.end() - static_cast<std::ptrdiff_t>(hdf5::sealed({}).size()));
    const results::Recording known = results::read_recording(data / name);
    int refused = 0;
    for (int k = 0; k < files; ++k) {
      publish("a.h5", k % 2 == 0 ? with_other_values(good, random) : hdf5::sealed(altered(content, random)));
      try {
        results::validate(program.folder() / "a.h5");
        const results::Recording recording = results::read_recording(program.folder() / "a.h5");
        results::overview(std::span(&recording, 1));
        results::compare(known, recording, {});
        results::compare(recording, known, {});
        for (const results::RunRecord& run : recording.runs) results::in_full(run);
      } catch (const base::FileError& error) {
        ++refused;
        EXPECT_STRNE(error.what(), "");
        if (std::string(error.what()).find("made to do harm") != std::string::npos) ++stopped;
      }
    }
    RecordProperty(fmt::format("refused_{}", name), refused);
    EXPECT_GT(refused, 0) << name;
  }
  RecordProperty("stopped", stopped);
}

TEST_F(FuzzHdf5, MotionsOfOthers) {
  const results::Motion motion{{0, 0.1, 0.2}, {3, solver::Vectors::Zero(12, 3)}, {3, solver::Vectors::Zero(12, 3)}};
  const Bytes good = results::to_bytes(results::ReferenceMotion{"", "", motion, {0, 0, 0}});
  for (int k = 0; k < files / 2 && !HasFailure(); ++k) {
    publish("a.h5", altered(good, random));
    EXPECT_EQ(run_limited(program, {"score", "--scene", "hung-edge", "a.h5", "--out", "s.h5"}).exit_code, 2);
    keep_if_failed(fmt::format("motions-{}", k));
  }
}

}  // namespace
}  // namespace drape::verify::fuzz_hdf5_test
