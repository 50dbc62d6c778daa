#include "results/file/hdf5_copy.hpp"

#include <algorithm>
#include <cstring>
#include <set>
#include <sstream>
#include <string_view>

#include "results/file/hdf5_value.hpp"
#include "solver/base/sandbox.hpp"

namespace drape::results::hdf5 {
namespace {

constexpr std::size_t mebi = 1 << 20;
constexpr int deepest = 16;  ///< groups in groups

/// The product of extents, and of the size of a number; Error if it is beyond all files.
std::uint64_t product(const std::vector<std::uint64_t>& extents, std::uint64_t size, const std::string& path) {
  std::uint64_t all = size;
  for (const std::uint64_t extent : extents)
    if (__builtin_mul_overflow(all, extent, &all))
      throw Error(fmt::format("{}: declares more numbers than there can be", path));
  return all;
}

/// What datasets may declare: no more than they store, nor together than a file may.
class Budget {
 public:
  explicit Budget(std::size_t file_size) : file_size_(file_size) {}

  /// Throws Error unless all of a dataset is in the file and not too much; before it is read.
  void admit(const Handle& dataset, const std::vector<std::uint64_t>& shape, const std::string& path) {
    const Handle creation(H5Dget_create_plist(dataset.id()), path), type(H5Dget_type(dataset.id()), path);
    const H5D_layout_t layout = H5Pget_layout(creation.id());
    if (layout == H5D_VIRTUAL || H5Pget_external_count(creation.id()) != 0)
      throw Error(fmt::format("{}: is stored in other files", path));
    const std::uint64_t size = H5Tget_size(type.id()), stored = H5Dget_storage_size(dataset.id());
    const std::uint64_t declared =
        layout == H5D_CHUNKED ? declared_in_chunks(dataset, creation, shape, size, path) : product(shape, size, path);
    constexpr std::uint64_t densest = 1032;  // what deflate can do
    if (declared / (layout == H5D_CHUNKED ? densest : 1) > stored)
      throw Error(fmt::format("{}: declares {} bytes, but stores only {}", path, declared, stored));
    stored_ += stored, declared_ += declared;
    if (stored_ > file_size_) throw Error(fmt::format("{}: is stored where something else is", path));
    if (declared_ > most_numbers(file_size_))
      throw Error(
          fmt::format("{}: holds more than {} MiB of numbers with those before it", path, most_numbers(file_size_) / mebi));
  }

  /// A text that many rows refer to is stored once, but takes memory in each.
  std::size_t text_left() const { return file_size_ - texts_; }

  void count(const Value& value, const std::string& path) {
    std::uint64_t size = 0;
    for (const std::string& text : value.texts) size += text.size();
    if (size > text_left()) throw Error(fmt::format("{}: has more text than there is in the file", path));
    texts_ += size;
  }

 private:
  static std::uint64_t declared_in_chunks(const Handle& dataset, const Handle& creation,
                                          const std::vector<std::uint64_t>& shape, std::uint64_t size,
                                          const std::string& path) {
    std::vector<hsize_t> chunk(shape.size());
    if (H5Pget_chunk(creation.id(), static_cast<int>(chunk.size()), chunk.data()) != static_cast<int>(chunk.size()))
      throw Error(fmt::format("{}: its chunks have other dimensions", path));
    std::vector<std::uint64_t> padded;
    for (std::size_t k = 0; k < chunk.size(); ++k)
      padded.push_back((shape[k] / chunk[k] + (shape[k] % chunk[k] != 0)) * chunk[k]);
    const Handle space(H5Dget_space(dataset.id()), path);
    hsize_t there = 0;
    check(H5Dget_num_chunks(dataset.id(), space.id(), &there), path);
    const std::uint64_t declared = product(padded, size, path), a_chunk = product({chunk.begin(), chunk.end()}, size, path);
    if (a_chunk == 0 || there != declared / a_chunk) throw Error(fmt::format("{}: some of its chunks are missing", path));
    return declared;
  }

  std::uint64_t file_size_, stored_ = 0, declared_ = 0, texts_ = 0;
};

/// What is in the copy of a file, and what another program has done to the file.
class Copier {
 public:
  Copier(const Handle& from, const Sealed& file)
      : from_(H5Gopen2(from.id(), "/", H5P_DEFAULT), "/"),
        to_(create_in_memory()),
        ours_(file.sealed),
        budget_(file.content.size()) {
    if (!ours_) require_signed(from, file.content.size());
    is_new(from_);
    copy_members(from_, to_, "", 0);
    copy_attributes(from_, to_, "");
  }

  std::vector<std::byte> image() const { return raw_image(to_); }
  const std::vector<std::string>& added() const { return added_; }
  const std::vector<std::string>& altered() const { return altered_; }

 private:
  void require_signed(const Handle& from, std::size_t size) const {
    const ssize_t known = check(H5Fget_file_image(from.id(), nullptr, 0), "end");  // to the library
    if (static_cast<std::size_t>(known) != size || !signature_of(from_).contains(key_of("")))
      throw Error("has been truncated, or is of another program or an older version: there is no checksum at its end");
  }

  /// Whether no link before led to this object.
  bool is_new(const Handle& object) {
    H5O_info_t info;
    check(H5Oget_info2(object.id(), &info, H5O_INFO_BASIC), "object");
    return seen_.insert(info.addr).second;
  }

  /// Whether something is ours; if it is, notes that it is no longer what it was.
  bool is_ours(const Signature& signature, const std::string& path, std::uint64_t hash) {
    if (ours_) return true;
    const auto entry = signature.find(key_of(path));
    if (entry == signature.end()) return added_.push_back(path), false;
    if (entry->second != hash) altered_.push_back(path);
    return true;
  }

  void copy_attributes(const Handle& from, const Handle& to, const std::string& path) {
    const Signature signature = signature_of(from);
    std::size_t ours = 1;  // the object itself
    for (const std::string& name : attributes(from, H5_INDEX_CRT_ORDER)) {
      const std::string where = fmt::format("{}@{}", path, name);
      const Value value = read_value(Handle(H5Aopen(from.id(), name.c_str(), H5P_DEFAULT), where), where);
      budget_.count(value, where);
      if (!is_ours(signature, where, hash_of(value))) continue;
      ++ours;
      if (value.type == "other")
        mark_other(to, name);
      else
        write_attribute(to, name, value);
    }
    if (!ours_ && ours < signature.size()) altered_.push_back(path + "@");
  }

  /// An attribute that inventory() calls "other".
  static void mark_other(const Handle& to, const std::string& name) {
    const Handle space(H5Screate(H5S_SCALAR), name);
    const Handle mark(H5Acreate2(to.id(), name.c_str(), H5T_STD_U8LE, space.id(), H5P_DEFAULT, H5P_DEFAULT), name);
  }

  void copy_members(const Handle& from, const Handle& to, const std::string& path, int depth) {
    if (depth > deepest) throw Error(fmt::format("{}: more than {} groups in groups", path, deepest));
    std::vector<std::string> ours;
    for (const std::string& name : links(from))
      if (copy_member(from, to, name, fmt::format("{}/{}", path, name), depth)) ours.push_back(name);
    if (!ours_ && signature_of(from)[key_of(path)] != hash_of(ours)) altered_.push_back(path + "/");
  }

  /// Whether it is ours.
  bool copy_member(const Handle& from, const Handle& to, const std::string& name, const std::string& where, int depth) {
    H5L_info_t link;
    check(H5Lget_info(from.id(), name.c_str(), &link, H5P_DEFAULT), where);
    if (link.type == H5L_TYPE_HARD) {
      const Handle object(H5Oopen(from.id(), name.c_str(), H5P_DEFAULT), where);
      const bool in_place = ours_ || signature_of(object).contains(key_of(where));
      if (in_place && is_new(object) && copy_object(object, to, name, where, depth)) return true;
    }
    if (!ours_) return added_.push_back(where), false;
    check(H5Lcreate_soft("/another object", to.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), where);
    return true;
  }

  /// Whether it is ours and of a kind that is written here.
  bool copy_object(const Handle& object, const Handle& to, const std::string& name, const std::string& where, int depth) {
    const H5I_type_t kind = H5Iget_type(object.id());
    if (kind == H5I_GROUP) {
      const Handle group(H5Gcreate2(to.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), where);
      copy_members(object, group, where, depth + 1);
      copy_attributes(object, group, where);
      return true;
    }
    return kind == H5I_DATASET && copy_dataset(object, to, name, where);
  }

  bool copy_dataset(const Handle& dataset, const Handle& to, const std::string& name, const std::string& where) {
    const Value declared = declaration(dataset, where);
    if (declared.type == "other") return false;
    budget_.admit(dataset, declared.shape, where);
    const Value value = read_value(dataset, where, budget_.text_left());
    budget_.count(value, where);
    is_ours(signature_of(dataset), where, hash_of(value));
    write_dataset(to, name, value);
    copy_attributes(dataset, Handle(H5Dopen2(to.id(), name.c_str(), H5P_DEFAULT), where), where);
    return true;
  }

  Handle from_, to_;
  bool ours_;  ///< all of it
  Budget budget_;
  std::set<haddr_t> seen_;
  std::vector<std::string> added_, altered_;
};

// --- From one process to the other: two lists of lines, each with its length before it, and the image --------------------

void put_lines(std::vector<std::byte>& out, const std::vector<std::string>& lines) {
  const std::string text = fmt::format("{}", fmt::join(lines, "\n"));
  const std::uint64_t length = text.size();
  const auto append = [&](std::span<const std::byte> bytes) { out.insert(out.end(), bytes.begin(), bytes.end()); };
  append(std::as_bytes(std::span(&length, 1)));
  append(std::as_bytes(std::span(text)));
}

std::vector<std::string> take_lines(std::span<const std::byte>& bytes) {
  std::uint64_t length = 0;
  std::memcpy(&length, bytes.data(), sizeof length);
  bytes = bytes.subspan(sizeof length);
  std::istringstream text(std::string(reinterpret_cast<const char*>(bytes.data()), length));
  bytes = bytes.subspan(length);
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

Handle open(const Sealed& file) {
  try {
    return open_raw_image(file.content);
  } catch (const Error& error) {
    throw Error(fmt::format("{}{}", file.sealed ? "" : "has been truncated, or is of another program: ", error.what()));
  }
}

std::vector<std::byte> copy_of(const Sealed& file) {
  const Copier copier(open(file), file);
  std::vector<std::byte> bytes;
  put_lines(bytes, copier.added());
  put_lines(bytes, copier.altered());
  const auto image = copier.image();
  bytes.insert(bytes.end(), image.begin(), image.end());
  return bytes;
}

base::SandboxLimits limits_for(std::size_t file_size) {
  constexpr std::size_t copies = 3;  // a dataset, the image with it, that image for the other process
  return {32 * mebi + copies * most_numbers(file_size) + 4 * file_size, 10 + static_cast<double>(file_size) / mebi};
}

}  // namespace

std::size_t most_numbers(std::size_t file_size) { return 32 * mebi + 128 * file_size; }

Opened copied_in_sandbox(const Sealed& file) {
  H5open();  // once, and not in every copy of this process
  try {
    const auto bytes = base::in_sandbox([&] { return copy_of(file); }, limits_for(file.content.size()));
    std::span<const std::byte> rest = bytes;
    std::vector<std::string> added = take_lines(rest), altered = take_lines(rest);
    return {open_raw_image(rest), std::move(added), std::move(altered)};
  } catch (const base::SandboxEnded& error) {
    throw Error(fmt::format("is damaged, or made to do harm: reading it {}", error.what()));
  } catch (const base::SandboxError& error) {
    throw Error(error.what());
  }
}

}  // namespace drape::results::hdf5
