#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "results/file/journal.hpp"

/// A sweep that several processes share, on one machine or on many.
namespace drape::bench {

/// The part of a sweep that a process computes: number i of n, counted from 1. The others compute the rest.
struct Share {
  int number;
  int count;
};

/// "2/5", and back; none if it is not such a text with 1 <= i <= n <= 10000.
std::string to_string(const Share& share);
std::optional<Share> share_named(std::string_view text);

/// The number of the shard, from 1 to `count`, that computes what has this key. It depends on nothing else: what is added to a
/// sweep moves nothing.
int shard_of(std::string_view key, int count);

/// A shard records nothing but its journal, that of this file: OUT.shard-2-of-5. The journal is kept.
std::filesystem::path shard_file(const std::filesystem::path& out, const Share& share);

/// The first ten, for a message: "a, b, ...".
std::string first_of(const std::vector<std::string>& names);

/// Checkpoints by their ids.
using Checkpoints = std::map<std::string, results::Journal::Bytes>;

/// Thrown where a sweep needs a checkpoint that another shard computes and that is not there yet. No std::exception, so that it
/// does not pass for the failure of a run.
struct ComputedElsewhere {};

/// What a process knows of the shards of its sweep.
class Shards {
 public:
  /// `share`: what this process computes; a number of 0 is nothing. `others`: what other processes have computed.
  Shards(const Share& share, Checkpoints others) : share_(share), others_(std::move(others)) {}

  /// What another process has computed; null if none has.
  const results::Journal::Bytes* find(const std::string& id) const;

  /// Throws ComputedElsewhere unless this process is to compute what belongs to `key`, and then remembers that `id` is missing.
  void require_own(const std::string& id, const std::string& key);

  /// The ids that others have yet to compute, and the numbers of their shards. There may be more behind them.
  const std::map<std::string, int>& missing() const { return missing_; }

 private:
  Share share_;
  Checkpoints others_;
  std::map<std::string, int> missing_;
};

/// The checkpoints of the other shards of a sweep, as far as their journals lie beside this one's and are of the same program.
/// `facts`: of this process.
Checkpoints checkpoints_beside(const std::filesystem::path& out, const Share& share, const results::Provenance& facts);

/// A journal of a shard notes where it comes from under this id; it is no checkpoint.
constexpr const char* origin_id = "origin";
results::Journal::Bytes origin(const results::Provenance& facts, const Share& share);

/// The journals of shards, to be merged.
struct ShardJournals {
  Share share;  ///< computes nothing
  results::Provenance
      facts;  ///< what they have in common; where the processors, hosts or starts differ, all of them or the first
  Checkpoints checkpoints;  ///< of all
  std::vector<std::string> processors;
};

/// What is known of a shard's start. Throws FileError if the file is not the journal of a shard.
results::Provenance origin_of(const std::filesystem::path& journal);

/// Throws FileError, naming the files, if one is not the journal of a shard or is not of the same sweep, commit, flags, program
/// and number of shards as the others and `own`, except for the processor; and if two have different results under an id.
ShardJournals read_shards(const std::vector<std::filesystem::path>& journals, const results::Provenance& own);

}  // namespace drape::bench
