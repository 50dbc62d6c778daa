#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "results/provenance.hpp"
#include "results/run_record.hpp"
#include "results/table.hpp"
#include "solver/base/atomic_file.hpp"

namespace drape::results {

/// The HDF5 file of one sweep; its layout is in results/README.md. It is kept in memory and published as a whole after every
/// group of runs: on disk it is absent or complete and readable at any moment, whatever kills the program.
/// Not for use from several threads at once.
class RunFile {
 public:
  /// Writes nothing yet. Throws FileError if the file exists (nothing recorded is ever lost) or cannot be created. `resumed`: a
  /// file that exists is continued; then FileError, naming what differs, if it is not one of the same sweep by the same
  /// program.
  RunFile(std::filesystem::path path, const Provenance& provenance, Start start = Start::fresh);
  ~RunFile();

  /// On return the runs are on disk, all or none, as `/runs/000`, `/runs/001`, ... in the order of the calls. Throws FileError,
  /// then without the runs, if they cannot be written.
  void add(std::span<const RunRecord> runs);
  void add(const RunRecord& run) { add(std::span(&run, 1)); }

  /// On return the table is on disk, as `/tables/<name>`. Throws like the other.
  void add(const Table& table);

  /// Adds this moment to the times at which the file was continued; on disk with what is added next.
  void note_resumption();

  /// On return the file says, on disk, that nothing is missing. Throws like the others.
  void finish();

  bool begun() const;  ///< on disk
  std::size_t run_count() const;
  bool has_table(const std::string& name) const;
  bool finished() const;

  const std::filesystem::path& path() const { return path_; }

 private:
  struct Image;
  std::filesystem::path path_;
  std::unique_ptr<Image> image_;
};

/// What a file holds.
struct Recording {
  Provenance provenance;
  std::vector<RunRecord> runs;
  std::vector<Table> tables;
};

/// The name of a run's group in `/runs`, counted from 0: "000".
std::string run_name(std::size_t run);

/// A run as it would be in a file, and back. Throws FileError if these bytes are none.
std::vector<std::byte> to_bytes(const RunRecord& run);
RunRecord run_of(std::span<const std::byte> bytes);

/// All runs of a file, in the order they were added; their parameters and work counts are sorted by name.
/// Throws FileError if the file cannot be read or is not such a file.
std::vector<RunRecord> read_runs(const std::filesystem::path& path);

/// All tables of a file, sorted by name. Throws like read_runs().
std::vector<Table> read_tables(const std::filesystem::path& path);

/// Where the runs of a file come from. Throws like read_runs().
Provenance read_provenance(const std::filesystem::path& path);

/// All of that. Throws like read_runs().
Recording read_recording(const std::filesystem::path& path);

}  // namespace drape::results
