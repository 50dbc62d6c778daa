#include "results/file/journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "solver/base/hash.hpp"
#include "solver/base/input_file.hpp"
#include "solver/base/temporary.hpp"

namespace drape::results {
namespace fs = std::filesystem;
namespace {

using nlohmann::json;

/// Whether a path, which may be a link, leads to an open file: the holder of the lock removes it.
bool leads_to(const fs::path& path, int fd) {
  struct stat opened {
  }, named{};
  return fstat(fd, &opened) == 0 && stat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

/// Opens and locks a file that is made if need be.
int open_locked(const fs::path& file, const fs::path& path) {
  for (;;) {
    const int fd = open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (fd < 0) base::fail_to_create_beside(file);
    if (flock(fd, LOCK_EX | LOCK_NB) != 0) {
      const bool taken = errno == EWOULDBLOCK;
      if (!taken) base::fail(path, "cannot be locked");
      close(fd);
      throw base::FileError(
          fmt::format("{}: another process is recording in it; wait for it or choose another --out", file.string()));
    }
    if (leads_to(path, fd)) return fd;
    close(fd);
  }
}

Journal::Bytes header_of(const Provenance& provenance) {
  json facts = json::array();
  for (const Fact& fact : lasting(provenance)) facts.push_back({fact.name, fact.value});
  return json::to_cbor(facts);
}

/// Stops where arrays are deeper than those of a journal: the reader of nested ones would need a stack as deep.
struct Shallow : nlohmann::json_sax<json> {
  int depth = 0;
  bool start_array(std::size_t) override { return ++depth <= 2; }
  bool end_array() override { return --depth >= 0; }
  bool start_object(std::size_t) override { return false; }
  bool end_object() override { return false; }
  bool key(string_t&) override { return false; }
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool parse_error(std::size_t, const std::string&, const json::exception&) override { return false; }
};

/// The next item of a sequence; discarded if it is not complete.
json next_item(std::istream& sequence) {
  const auto begin = sequence.tellg();
  Shallow shallow;
  if (!json::sax_parse(sequence, &shallow, json::input_format_t::cbor, /*strict=*/false)) return json::value_t::discarded;
  sequence.seekg(begin);
  try {
    return json::from_cbor(sequence, /*strict=*/false);
  } catch (const json::exception&) {
    return json::value_t::discarded;
  }
}

/// The facts at the beginning of a journal; none if it has no such beginning.
Provenance facts_in(const json& header) {
  Provenance facts;
  if (!header.is_array()) return facts;
  for (const json& fact : header)
    if (fact.is_array() && fact.size() == 2 && fact[0].is_string() && fact[1].is_string())
      facts.push_back({fact[0].get<std::string>(), fact[1].get<std::string>(), ""});
  return facts;
}

std::uint64_t checksum(const std::string& id, const Journal::Bytes& value) {
  return base::hash({reinterpret_cast<const char*>(value.data()), value.size()}, base::hash(id));
}

bool is_checkpoint(const json& item) {
  return item.is_array() && item.size() == 3 && item[0].is_string() && item[1].is_binary() && item[2].is_number_unsigned() &&
         item[2] == checksum(item[0].get<std::string>(), item[1].get_binary());
}

std::string content(const fs::path& path) {
  try {
    return base::content_of(path, std::numeric_limits<std::uintmax_t>::max());
  } catch (const base::UnreadableFile& error) {
    throw base::FileError(fmt::format("{}: {}: expected a journal of this program; remove it", path.string(), error.what()));
  }
}

/// What a journal begins with: its complete part.
struct Beginning {
  JournalContent content;
  std::streamoff size = 0;  ///< [bytes]
};

Beginning beginning(const std::string& bytes, const fs::path& path) {
  std::istringstream sequence(bytes);
  Beginning all{{facts_in(next_item(sequence)), {}}};
  if (all.content.facts.empty())
    throw base::FileError(fmt::format("{}: is not a journal of this program; remove it", path.string()));
  all.size = sequence.tellg();
  for (json item = next_item(sequence); is_checkpoint(item); item = next_item(sequence)) {
    all.content.entries.insert_or_assign(item[0].get<std::string>(), Journal::Bytes(item[1].get_binary()));
    all.size = sequence.tellg();
  }
  return all;
}

}  // namespace

JournalContent read_journal(const fs::path& path) {
  const std::string bytes = content(path);
  return bytes.empty() ? JournalContent() : beginning(bytes, path).content;
}

Journal::Journal(const fs::path& file, const Provenance& provenance, Start start)
    : file_(file), path_(file.string() + ".journal"), lock_(open_locked(file_, path_)), header_(header_of(provenance)) {
  base::remove_leftovers(base::folder_of(file_));
  read(provenance, start);
}

Journal::~Journal() {
  if (entries_.empty()) unlink(path_.c_str());
}

void Journal::read(const Provenance& provenance, Start start) {
  const std::string bytes = content(path_);
  if (std::string(header_.begin(), header_.end()).starts_with(bytes)) return clear();
  auto [theirs, good] = beginning(bytes, path_);
  entries_ = std::move(theirs.entries);
  if (entries_.empty()) return clear();
  if (start == Start::fresh)
    throw base::FileError(
        fmt::format("{} is left of a sweep that did not end; continue it by --resume, or remove it", path_.string()));
  if (const std::string why = why_not_resumed(theirs.facts, provenance); !why.empty())
    throw base::FileError(fmt::format("{}: cannot be continued: {}; choose another --out, or remove it", path_.string(), why));
  if (ftruncate(lock_.fd, good) != 0) base::fail(path_, "cannot be written");
}

const Journal::Bytes* Journal::find(const std::string& id) const {
  const auto found = entries_.find(id);
  return found == entries_.end() ? nullptr : &found->second;
}

void Journal::add(const std::string& id, Bytes value) {
  Bytes bytes = entries_.empty() ? header_ : Bytes();
  json::to_cbor(json::array({id, json::binary(value), checksum(id, value)}), bytes);
  const off_t before = lseek(lock_.fd, 0, SEEK_END);
  try {
    base::write_all(path_, lock_.fd, std::as_bytes(std::span(bytes)));
  } catch (const base::FileError&) {
    if (ftruncate(lock_.fd, before) != 0) throw;  // then its end is incomplete, which the next reader cuts off
    throw;
  }
  entries_.insert_or_assign(id, std::move(value));
}

void Journal::clear() {
  entries_.clear();
  if (ftruncate(lock_.fd, 0) != 0) base::fail(path_, "cannot be written");
}

}  // namespace drape::results
