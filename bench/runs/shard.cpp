#include "bench/runs/shard.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <system_error>

#include "solver/base/atomic_file.hpp"
#include "solver/base/hash.hpp"

namespace drape::bench {
namespace fs = std::filesystem;
namespace {

using results::Fact;
using results::Provenance;

const std::string share_fact = "shard";

/// Results without times may come from several kinds of processors.
Provenance without_processor(Provenance facts) {
  std::erase_if(facts, [](const Fact& fact) { return fact.name == "cpu"; });
  return facts;
}

void require_same_program(const fs::path& journal, const Provenance& theirs, const Provenance& ours) {
  if (const std::string why = why_not_resumed(theirs, without_processor(ours)); !why.empty())
    throw base::FileError(fmt::format("{}: cannot be merged: {}", journal.string(), why));
}

struct ReadShard {
  fs::path path;
  Provenance origin;
  Share share;
  Checkpoints checkpoints;
};

/// Texts that end in a zero byte: name, value and description of each fact.
Provenance facts_in(const results::Journal::Bytes& bytes) {
  std::vector<std::string> texts(1);
  for (const auto byte : bytes)
    if (byte == 0)
      texts.emplace_back();
    else
      texts.back() += static_cast<char>(byte);
  Provenance facts;
  for (std::size_t k = 0; k + 3 < texts.size(); k += 3) facts.push_back({texts[k], texts[k + 1], texts[k + 2]});
  return facts;
}

ReadShard read_shard(const fs::path& path) {
  auto [facts, entries] = results::read_journal(path);
  Provenance origin = facts_in(entries[origin_id]);
  const auto share = share_named(value_of(origin, share_fact));
  if (!share) throw base::FileError(fmt::format("{}: is not the journal of a shard", path.string()));
  entries.erase(origin_id);
  return {path, std::move(origin), *share, std::move(entries)};
}

/// Our own command line and the earliest start; of what else may differ all that there is.
Provenance in_common(const std::vector<ReadShard>& shards, const Provenance& own) {
  Provenance facts;
  for (Fact fact : shards.front().origin) {
    if (fact.name == share_fact) continue;
    std::vector<std::string> values;
    for (const ReadShard& shard : shards) values.push_back(value_of(shard.origin, fact.name));
    std::ranges::sort(values);
    const auto [end, last] = std::ranges::unique(values);
    values.erase(end, last);
    if (fact.name == "command_line")
      fact.value = value_of(own, fact.name);
    else
      fact.value = fact.name == "started" ? values.front() : fmt::format("{}", fmt::join(values, "; "));
    facts.push_back(std::move(fact));
  }
  return facts;
}

/// Throws FileError if two shards have different results under an id.
Checkpoints united(const std::vector<ReadShard>& shards) {
  Checkpoints all;
  std::map<std::string, const ReadShard*> from;
  std::vector<std::string> twice;
  for (const ReadShard& shard : shards)
    for (const auto& [id, bytes] : shard.checkpoints)
      if (const auto [known, added] = all.emplace(id, bytes); added)
        from[id] = &shard;
      else if (known->second != bytes)
        twice.push_back(fmt::format("'{}' in {} and {}", id, from[id]->path.string(), shard.path.string()));
  if (twice.empty()) return all;
  throw base::FileError(
      fmt::format("{} checkpoints are there twice with different results, which one is meant is not known: {}", twice.size(),
                  first_of(twice)));
}

}  // namespace

std::string to_string(const Share& share) { return fmt::format("{}/{}", share.number, share.count); }

std::optional<Share> share_named(std::string_view text) {
  constexpr int most = 10000;
  Share share{};
  const char* const end = text.data() + text.size();
  const auto [slash, bad_number] = std::from_chars(text.data(), end, share.number);
  if (bad_number != std::errc() || slash == end || *slash != '/') return std::nullopt;
  const auto [last, bad_count] = std::from_chars(slash + 1, end, share.count);
  if (bad_count != std::errc() || last != end || share.number < 1 || share.number > share.count || share.count > most)
    return std::nullopt;
  return share;
}

int shard_of(std::string_view key, int count) { return 1 + static_cast<int>(base::hash(key) % static_cast<unsigned>(count)); }

fs::path shard_file(const fs::path& out, const Share& share) {
  return fmt::format("{}.shard-{}-of-{}", out.string(), share.number, share.count);
}

std::string first_of(const std::vector<std::string>& names) {
  constexpr std::size_t most = 10;
  return fmt::format("{}{}", fmt::join(names.begin(), names.begin() + std::min(names.size(), most), ", "),
                     names.size() > most ? ", ..." : "");
}

const results::Journal::Bytes* Shards::find(const std::string& id) const {
  const auto found = others_.find(id);
  return found == others_.end() ? nullptr : &found->second;
}

void Shards::require_own(const std::string& id, const std::string& key) {
  const int number = shard_of(key, share_.count);
  if (number == share_.number) return;
  missing_.emplace(id, number);
  throw ComputedElsewhere();
}

Checkpoints checkpoints_beside(const fs::path& out, const Share& share, const Provenance& facts) {
  Checkpoints all;
  for (int number = 1; number <= share.count; ++number) {
    const fs::path journal = shard_file(out, {number, share.count}).string() + ".journal";
    if (std::error_code unreachable; number == share.number || !fs::exists(journal, unreachable)) continue;
    auto [theirs, entries] = results::read_journal(journal);
    if (entries.empty()) continue;
    require_same_program(journal, theirs, facts);
    all.merge(entries);
  }
  return all;
}

results::Journal::Bytes origin(const Provenance& facts, const Share& share) {
  results::Journal::Bytes bytes;
  const auto add = [&](const Fact& fact) {
    for (const std::string* text : {&fact.name, &fact.value, &fact.description})
      bytes.insert(bytes.end(), text->c_str(), text->c_str() + text->size() + 1);
  };
  std::ranges::for_each(facts, add);
  add({share_fact, to_string(share), "its number, and how many there are"});
  return bytes;
}

Provenance origin_of(const fs::path& journal) { return read_shard(journal).origin; }

ShardJournals read_shards(const std::vector<fs::path>& journals, const Provenance& own) {
  std::vector<ReadShard> shards;
  std::vector<std::string> processors;
  for (const fs::path& path : journals) {
    const ReadShard& shard = shards.emplace_back(read_shard(path));
    require_same_program(path, shard.origin, own);
    if (shard.share.count != shards.front().share.count)
      throw base::FileError(
          fmt::format("{}: cannot be merged: it is shard {}, and {} is shard {}; expected the same number of shards",
                      path.string(), to_string(shard.share), journals.front().string(), to_string(shards.front().share)));
    if (const std::string cpu = value_of(shard.origin, "cpu"); std::ranges::find(processors, cpu) == processors.end())
      processors.push_back(cpu);
  }
  return {{0, shards.front().share.count}, in_common(shards, own), united(shards), processors};
}

}  // namespace drape::bench
