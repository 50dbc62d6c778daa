#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "results/atomic_file.hpp"
#include "results/provenance.hpp"
#include "results/run_record.hpp"
#include "results/table.hpp"

namespace drape::results {

/// The HDF5 file of one invocation of a program; its layout is in results/README.md. It is kept in memory and published as a
/// whole after every run: on disk it is absent or complete and readable at any moment, whatever kills the program.
/// Not for use from several threads at once.
class RunFile {
 public:
  /// Writes nothing yet. Throws FileError if the file exists (nothing recorded is ever lost) or cannot be created.
  RunFile(std::filesystem::path path, const Provenance& provenance);
  ~RunFile();

  /// On return the run is on disk, as `/runs/000`, `/runs/001`, ... in the order of the calls. Throws FileError, then
  /// without the run, if it cannot be written.
  void add(const RunRecord& run);

  /// On return the table is on disk, as `/tables/<name>`. Throws like the other.
  void add(const Table& table);

  const std::filesystem::path& path() const { return path_; }

 private:
  struct Image;
  std::filesystem::path path_;
  std::unique_ptr<Image> image_;
};

/// The name of a run's group in `/runs`, counted from 0: "000".
std::string run_name(std::size_t run);

/// All runs of a file, in the order they were added; their parameters and work counts are sorted by name.
/// Throws FileError if the file cannot be read or is not such a file.
std::vector<RunRecord> read_runs(const std::filesystem::path& path);

/// All tables of a file, sorted by name. Throws like read_runs().
std::vector<Table> read_tables(const std::filesystem::path& path);

/// Where the runs of a file come from. Throws like read_runs().
Provenance read_provenance(const std::filesystem::path& path);

}  // namespace drape::results
