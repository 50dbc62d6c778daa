// The specification of the record file: what the program writes keeps to it, every planted deviation is found, and files of
// this version stay readable.

#include "results/file/validate.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <ostream>
#include <span>

#include "results/file/hdf5.hpp"
#include "results/file/run_file.hpp"
#include "results/file/schema.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify::validate_test {
namespace {

namespace fs = std::filesystem;
using namespace results;
using hdf5::Handle;
using testing::IsEmpty;
using testing::SizeIs;

const fs::path data = fs::path(DRAPE_SOURCE_DIR) / "verify/data";
const fs::path old_runs = data / "runs-schema-4.h5", old_tables = data / "tables-schema-4.h5";

TEST(OldFiles, KeepToTheSpecification) {
  EXPECT_THAT(validate(old_runs), IsEmpty());
  EXPECT_THAT(validate(old_tables), IsEmpty());
}

TEST(OldFiles, StayReadable) {
  const auto runs = read_runs(old_runs);
  ASSERT_THAT(runs, SizeIs(1));
  EXPECT_EQ(runs[0].method, "bdf2");
  EXPECT_EQ(runs[0].outcome, solver::Outcome::success);
  EXPECT_THAT(runs[0].steps, SizeIs(2));
  EXPECT_THAT(runs[0].times_ms, SizeIs(1));
  EXPECT_EQ(runs[0].final_state.x.rows(), 9);
  EXPECT_TRUE(runs[0].error.has_value());
  EXPECT_TRUE(runs[0].contact.has_value());
  const auto tables = read_tables(old_tables);
  ASSERT_THAT(tables, SizeIs(1));
  EXPECT_EQ(tables[0].name, "figure-3.3");
  EXPECT_THAT(tables[0].columns.front().cells, SizeIs(4));
}

// --- Planted deviations --------------------------------------------------------------------------------------------------

/// A good file is changed; the deviations that must be found.
struct Deviation {
  std::string name;
  fs::path file;
  std::function<void(const Handle& file)> plant;
  std::vector<std::string> found;
};

std::ostream& operator<<(std::ostream& out, const Deviation& deviation) { return out << deviation.name; }

template <class Number>
void replace(const Handle& file, const std::string& path, const std::vector<Number>& values, std::vector<std::uint64_t> shape,
             const std::string& unit) {
  hdf5::remove(file, path);
  hdf5::write_numbers(file, path, values.data(), std::move(shape), unit, "planted");
}

const std::vector<Deviation> deviations = {
    {"None", old_runs, [](const Handle&) {}, {}},
    {"MissingDataset",
     old_runs,
     [](const Handle& f) { hdf5::remove(f, "runs/000/steps/cg_iterations"); },
     {"/runs/000/steps/cg_iterations: is missing"}},
    {"MissingGroup", old_runs, [](const Handle& f) { hdf5::remove(f, "tables"); }, {"/tables: is missing"}},
    {"MissingMemberOfError",
     old_runs,
     [](const Handle& f) { hdf5::remove(f, "runs/000/error/growth"); },
     {"/runs/000/error/growth: is missing"}},
    {"ExtraDataset",
     old_runs,
     [](const Handle& f) {
       const double one = 1;
       hdf5::write_numbers(f, "runs/000/speed", &one, {}, "m/s", "planted");
     },
     {"/runs/000/speed: is not in the specification", "/runs/000/speed@description: is not in the specification",
      "/runs/000/speed@unit: is not in the specification"}},
    {"ExtraAttribute",
     old_runs,
     [](const Handle& f) { hdf5::write_text(hdf5::open_group(f, "runs/000"), "colour", "red"); },
     {"/runs/000@colour: is not in the specification"}},
    {"RunOutOfOrder",
     old_runs,
     [](const Handle& f) { hdf5::create_group(f, "runs/002", "planted"); },
     {"/runs/002: is not in the specification", "/runs/002@description: is not in the specification"}},
    {"WrongType",
     old_runs,
     [](const Handle& f) {
       replace<int>(f, "runs/000/steps/t", {1, 2}, {2}, "s");
     },
     {"/runs/000/steps/t: is int32 instead of float64", "/runs/000/steps/t@description: is not in the specification",
      "/runs/000/steps/t@unit: is not in the specification"}},
    {"WrongUnit",
     old_runs,
     [](const Handle& f) { replace<double>(f, "runs/000/until", {1}, {}, "ms"); },
     {"/runs/000/until: its unit is 'ms' instead of 's'"}},
    {"WrongDimensions",
     old_runs,
     [](const Handle& f) { replace<double>(f, "runs/000/until", {1}, {1}, "s"); },
     {"/runs/000/until: has 1 dimensions instead of 0"}},
    {"OneStepLess",
     old_runs,
     [](const Handle& f) { replace<double>(f, "runs/000/steps/h", {1}, {1}, "s"); },
     {"/runs/000/steps/h: has 1 steps instead of 2"}},
    {"OneParticleLess",
     old_runs,
     [](const Handle& f) {
       replace<double>(f, "runs/000/final_state/v", std::vector<double>(24), {8, 3}, "m/s");
     },
     {"/runs/000/final_state/v: has 8 particles instead of 9"}},
    {"TwoCoordinates",
     old_runs,
     [](const Handle& f) {
       replace<double>(f, "runs/000/final_state/v", std::vector<double>(18), {9, 2}, "m/s");
     },
     {"/runs/000/final_state/v: has 2 columns instead of 3"}},
    {"CountThatIsReal",
     old_runs,
     [](const Handle& f) { replace<double>(f, "runs/000/work/steps", {1}, {}, "1"); },
     {"/runs/000/work/steps: is float64 instead of int64", "/runs/000/work/steps@description: is not in the specification",
      "/runs/000/work/steps@unit: is not in the specification"}},
    {"ShortColumn",
     old_tables,
     [](const Handle& f) {
       replace<double>(f, "tables/figure-3.3/t", {1, 2}, {2}, "s");
     },
     {"/tables/figure-3.3/t: has 2 rows instead of 4"}},
    {"MissingColumn",
     old_tables,
     [](const Handle& f) { hdf5::remove(f, "tables/figure-3.3/t"); },
     {"/tables/figure-3.3/t: is missing"}},
    {"ColumnThatIsNotListed",
     old_tables,
     [](const Handle& f) { hdf5::write_texts(f, "tables/figure-3.3/extra", {"a"}, "planted"); },
     {"/tables/figure-3.3/extra: is not in the specification",
      "/tables/figure-3.3/extra@description: is not in the specification",
      "/tables/figure-3.3/extra@unit: is not in the specification"}},
};

class Planted : public testing::TestWithParam<Deviation> {};

TEST_P(Planted, DeviationIsFoundAndNothingElse) {
  std::ifstream stream(GetParam().file, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(stream), {});
  const Handle file = hdf5::open_image(std::as_bytes(std::span(bytes)));
  GetParam().plant(file);
  const base::TemporaryFolder folder;
  base::publish(folder / "planted.h5", hdf5::image(file), base::Existing::refuse);
  EXPECT_THAT(validate(folder / "planted.h5"), testing::UnorderedElementsAreArray(GetParam().found));
}

INSTANTIATE_TEST_SUITE_P(All, Planted, testing::ValuesIn(deviations), [](const auto& d) { return d.param.name; });

TEST(Verdicts, LieInFilesAsDetailsWithStandings) {
  const base::TemporaryFolder folder;
  const std::vector<Datum> cells{Verdict{Standing::met, "below: by far"}, Verdict{Standing::missed}, "met: a text", ""};
  RunFile(folder / "a.h5", provenance("test")).add({"t", "about t", {{"verdict", "", "", "what", Role::verdict, cells, {}}}});
  EXPECT_EQ(read_tables(folder / "a.h5").at(0).columns.at(0).cells, cells);
  EXPECT_THAT(validate(folder / "a.h5"), IsEmpty());
  const Handle group = hdf5::open_group(hdf5::open_for_reading(folder / "a.h5"), "tables/t");
  EXPECT_THAT(hdf5::read_texts(group, "verdict.standing"), testing::ElementsAre("met", "missed", "", ""));
}

TEST(Validate, KnowsOneVersion) {
  const base::TemporaryFolder folder;
  const Handle file = hdf5::create_in_memory();
  hdf5::write_integer(file, "schema_version", schema_version + 1);
  base::publish(folder / "newer.h5", hdf5::image(file), base::Existing::refuse);
  EXPECT_THAT(validate(folder / "newer.h5"), testing::ElementsAre("@schema_version: is 7, this program knows 4 to 6"));
}

TEST(Validate, RefusesWhatIsNotHdf5) {
  EXPECT_THROW(validate(fs::path(DRAPE_SOURCE_DIR) / "README.md"), base::FileError);
  EXPECT_THROW(validate("no/such.h5"), base::FileError);
}

}  // namespace
}  // namespace drape::verify::validate_test
