#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "results/provenance.hpp"
#include "solver/base/descriptor.hpp"

namespace drape::results {

/// The checkpoints of a sweep that is not finished, in `FILE.journal` beside its file; and the lock that keeps other
/// processes from that file, which the system takes back when this one ends, however it ends.
///
/// A CBOR sequence (RFC 8742), which keeps NaN and infinities: the facts that tell who wrote it, then [id, bytes, checksum] for
/// each checkpoint. What a killed process left unfinished at the end is cut off.
class Journal {
 public:
  using Bytes = std::vector<std::uint8_t>;

  /// Throws FileError if another process holds the lock, if the folder cannot be written in, if there are checkpoints and
  /// `start` is fresh, or if they are of another program or sweep. Removes what killed processes have left in its folder.
  Journal(const std::filesystem::path& file, const Provenance& provenance, Start start);
  ~Journal();  ///< An empty journal is removed.
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }  ///< number of checkpoints

  /// What was recorded at a checkpoint, null if nothing was.
  const Bytes* find(const std::string& id) const;

  /// On return it is on disk. Throws FileError, then without it, if it cannot be written.
  void add(const std::string& id, Bytes value);

  /// Forgets all checkpoints: the file has what they were for.
  void clear();

 private:
  void read(const Provenance& provenance, Start start);

  std::filesystem::path file_, path_;
  base::Descriptor lock_;
  Bytes header_;
  std::map<std::string, Bytes> entries_;
};

/// What is in a journal, which its process may be writing.
struct JournalContent {
  Provenance facts;  ///< that all processes share which may write it
  std::map<std::string, Journal::Bytes> entries;
};

/// Reads a journal without its lock: all checkpoints that are complete. None, and no facts, if it has not begun. Throws
/// FileError if the file cannot be read or is not a journal.
JournalContent read_journal(const std::filesystem::path& path);

}  // namespace drape::results
