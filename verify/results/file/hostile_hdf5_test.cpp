// HDF5 files that are altered and sealed again, or changed by h5py: read, or refused in one line, in bounded memory and time.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "results/file/hdf5.hpp"
#include "results/file/motion_file.hpp"
#include "results/file/run_file.hpp"
#include "results/file/validate.hpp"
#include "verify/support/limited_program.hpp"

namespace drape::verify::hostile_hdf5_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;

const fs::path sources = DRAPE_SOURCE_DIR;
const fs::path runs_data = sources / "verify/data/runs-schema-4.h5", tables_data = sources / "verify/data/tables-schema-4.h5";

/// The program, and files that are made for it.
class HostileHdf5 : public testing::Test {
 protected:
  void publish(const std::string& name, std::vector<std::byte> bytes) const {
    base::publish(program.folder() / name, bytes, base::Existing::replace);
  }

  /// Lets h5py change a file; sealed again, it claims to be ours.
  void change(const std::string& kind, const std::string& name) const {
    const ProgramResult result = run_program({.program = "/usr/bin/python3",
                                              .arguments = {sources / "verify/support/hostile_hdf5.py", kind, name},
                                              .folder = program.folder(),
                                              .environment = {},
                                              .output = {}});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  void seal(const std::string& name) const { publish(name, results::hdf5::sealed(content_of(program.folder() / name))); }

  ProgramResult limited(const Words& words) const { return run_limited(program, words); }

  /// What all commands that read records say of one; they must agree that it is refused.
  std::string refused(const std::string& file) const {
    std::string said;
    for (const Words& words : {Words{"compare", file, file}, Words{"report", file, "--out", "page"}, Words{"inspect", file}}) {
      const ProgramResult result = limited(words);
      EXPECT_EQ(result.exit_code, 2) << joined(words, " ");
      EXPECT_THAT(result.err, HasSubstr(file)) << joined(words, " ");
      said = result.err;
    }
    return said;
  }

  /// The same of a table that is made hostile in some way.
  std::string refused_table(const std::string& kind) const {
    fs::copy_file(tables_data, program.folder() / "a.h5", fs::copy_options::overwrite_existing);
    change(kind, "a.h5");
    seal("a.h5");
    limited({"inspect", "a.h5", "--validate"});
    return refused("a.h5");
  }

  /// Records as the program writes them now.
  void write_runs(const std::string& name) const {
    const auto runs = results::read_runs(runs_data);
    results::Provenance facts = results::read_provenance(runs_data);
    std::erase_if(facts, [](const results::Fact& fact) { return fact.name == "resumed" || fact.name == "finished"; });
    results::RunFile file(program.folder() / name, facts);
    file.add(runs);
    file.add(results::read_tables(tables_data).at(0));
    file.finish();
  }

  BenchIntegrators program;
};

// --- One altered bit -----------------------------------------------------------------------------------------------------

TEST_F(HostileHdf5, HugeDeclaredTable) {
  EXPECT_THAT(refused_table("huge-table"), HasSubstr("declares 68719476736 bytes, but stores only 0"));
}

TEST_F(HostileHdf5, HugeDeclaredChunks) {
  EXPECT_THAT(refused_table("huge-chunked"), HasSubstr("some of its chunks are missing"));
  EXPECT_THAT(refused_table("huge-chunk"), HasSubstr("some of its chunks are missing"));
}

TEST_F(HostileHdf5, HugeDeclaredTexts) {
  EXPECT_THAT(refused_table("huge-texts"), HasSubstr("declares 68719476736 bytes, but stores only 0"));
}

TEST_F(HostileHdf5, OneTextInAHundredThousandRows) {
  EXPECT_THAT(refused_table("many-references"), HasSubstr("failed for VL data"));
}

TEST_F(HostileHdf5, DeflateBomb) { EXPECT_THAT(refused_table("bomb"), HasSubstr("MiB of numbers")); }

TEST_F(HostileHdf5, ShortColumnThatCrashesReport) {
  EXPECT_THAT(refused_table("short-column"), HasSubstr("are not equally long"));
}

// --- Links ---------------------------------------------------------------------------------------------------------------

TEST_F(HostileHdf5, HardLinkCycle) {
  fs::copy_file(runs_data, program.folder() / "a.h5");
  change("cycle", "a.h5");
  seal("a.h5");
  limited({"inspect", "a.h5", "--validate"});
  refused("a.h5");
}

TEST_F(HostileHdf5, TenThousandLinksToOneGroup) {
  fs::copy_file(runs_data, program.folder() / "a.h5");
  change("links", "a.h5");
  seal("a.h5");
  limited({"inspect", "a.h5", "--validate"});
  refused("a.h5");
}

TEST_F(HostileHdf5, AHundredGroupsInGroups) {
  EXPECT_THAT(refused_table("nested"), HasSubstr("more than 16 groups in groups"));
}

TEST_F(HostileHdf5, ExternalPipe) { EXPECT_THAT(refused_table("external"), HasSubstr("is stored in other files")); }

TEST_F(HostileHdf5, VirtualPipe) { EXPECT_THAT(refused_table("virtual"), HasSubstr("is stored in other files")); }

TEST_F(HostileHdf5, LinksThatLeadElsewhere) {
  refused_table("external-link");
  refused_table("soft-link");
}

// --- Not even a file -----------------------------------------------------------------------------------------------------

TEST_F(HostileHdf5, NoRegularFile) {
  ASSERT_EQ(mkfifo((program.folder() / "pipe.h5").c_str(), 0666), 0);
  EXPECT_THAT(refused("pipe.h5"), HasSubstr("is not a regular file"));
  EXPECT_THAT(refused("/dev/zero"), HasSubstr("is not a regular file"));
  EXPECT_THAT(refused("."), HasSubstr("is not a regular file"));
}

// --- What h5py has changed -----------------------------------------------------------------------------------------------

TEST_F(HostileHdf5, AnnotatedByH5pyIsReadable) {
  write_runs("a.h5");
  fs::copy_file(program.folder() / "a.h5", program.folder() / "good.h5");
  change("annotated", "a.h5");
  EXPECT_EQ(limited({"inspect", "a.h5"}).out, limited({"inspect", "good.h5"}).out);
  EXPECT_EQ(limited({"inspect", "a.h5", "--run", "0"}).out, limited({"inspect", "good.h5", "--run", "0"}).out);
  EXPECT_EQ(limited({"compare", "good.h5", "a.h5", "--no-times"}).exit_code, 0);
  EXPECT_EQ(limited({"report", "a.h5", "--out", "page"}).exit_code, 0);
  EXPECT_THAT(results::validate(program.folder() / "a.h5"),
              testing::UnorderedElementsAre(
                  "/mine: has been added by another program", "/runs/000/curve: has been added by another program",
                  "/runs/000/steps/same: has been added by another program",
                  "/runs/000/steps/t@colour: has been added by another program",
                  "/runs/000@rating: has been added by another program", "@note: has been added by another program"));
}

TEST_F(HostileHdf5, OpenedByH5pyIsAsItWas) {
  write_runs("a.h5");
  change("opened", "a.h5");
  EXPECT_THAT(results::validate(program.folder() / "a.h5"), IsEmpty());
}

TEST_F(HostileHdf5, AlteredByH5pyIsNamedAndRefused) {
  for (const auto& [kind, where] : {std::pair{"altered", "/runs/000/steps/t"},
                                    {"altered-text", "/runs/000@method"},
                                    {"removed", "/runs/"},
                                    {"renamed", "/runs/"}}) {
    const std::string name = fmt::format("{}.h5", kind);
    write_runs(name);
    change(kind, name);
    EXPECT_THAT(refused(name), HasSubstr(fmt::format("has been altered by another program: {}", where)));
    EXPECT_THAT(results::validate(program.folder() / name),
                testing::Contains(fmt::format("{}: has been altered by another program", where)));
  }
}

TEST_F(HostileHdf5, AnnotatedIsNotContinued) {
  const Words sweep{"run",      "--scene", "hung-edge", "--set", "grid.n=3", "--until", "0.02",  "--no-reference",
                    "--method", "bdf2",    "--step",    "0.01",  "--repeat", "1",       "--out", "a.h5"};
  program.output(sweep);
  change("annotated", "a.h5");
  const auto before = content_of(program.folder() / "a.h5");
  EXPECT_THAT(limited(sweep + Words{"--resume"}).err, HasSubstr("another program has changed"));
  EXPECT_EQ(content_of(program.folder() / "a.h5"), before);
}

TEST_F(HostileHdf5, OlderOrForeignIsToldFromAnnotated) {
  fs::copy_file(runs_data, program.folder() / "old.h5");
  change("opened", "old.h5");
  EXPECT_THAT(refused("old.h5"), HasSubstr("has been truncated, or is of another program or an older version"));
  write_runs("cut.h5");
  fs::resize_file(program.folder() / "cut.h5", fs::file_size(program.folder() / "cut.h5") - 1);
  EXPECT_THAT(refused("cut.h5"), HasSubstr("has been truncated"));
}

// --- Motions of other programs -------------------------------------------------------------------------------------------

TEST_F(HostileHdf5, MotionsThatAreNotWhatTheyDeclare) {
  for (const auto& [kind, complaint] : {std::pair{"motion-huge", "declares 4831838208 bytes, but stores only 0"},
                                        {"motion-chunked", "but stores only 0"},
                                        {"motion-bomb", "takes more memory"},
                                        {"motion-external", "is stored in other files"},
                                        {"motion-virtual", "is stored in other files"},
                                        {"motion-external-link", "expected a dataset /positions"}}) {
    const std::string name = fmt::format("{}.h5", kind);
    const results::Motion motion{{0, 0.1}, {2, solver::Vectors::Zero(12, 3)}, {}};
    publish(name, results::to_bytes(results::ReferenceMotion{"", "", motion, {0, 0}}));
    change(kind, name);
    const ProgramResult result = limited({"score", "--scene", "hung-edge", name, "--out", "s.h5"});
    EXPECT_EQ(result.exit_code, 2) << kind;
    EXPECT_THAT(result.err, HasSubstr(complaint)) << kind;
  }
}

}  // namespace
}  // namespace drape::verify::hostile_hdf5_test
