
#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

#include "results/file/hdf5_copy.hpp"
#include "results/file/hdf5_library.hpp"
#include "solver/base/hash.hpp"
#include "solver/base/sandbox.hpp"

namespace drape::results::hdf5 {
namespace {

/// Access to files that are in memory and stay there.
Handle in_memory() {
  constexpr std::size_t growth = 1 << 20;  // [bytes]
  Handle access(H5Pcreate(H5P_FILE_ACCESS), "file");
  check(H5Pset_fapl_core(access.id(), growth, /*backing_store=*/false), "file");
  return access;
}

/// What follows the library's part of a file: who wrote it, and the checksum of that part.
constexpr std::string_view seal_name = "drape: XXH3-128\n";
constexpr std::size_t seal_size = seal_name.size() + sizeof(base::LongHash);

std::array<std::byte, seal_size> seal_of(std::span<const std::byte> content) {
  std::array<std::byte, seal_size> seal{};
  const auto after_name = std::ranges::copy(std::as_bytes(std::span(seal_name)), seal.begin()).out;
  std::ranges::copy(base::long_hash(content), after_name);
  return seal;
}

bool begins(std::span<const std::byte> text, std::string_view with) {
  return text.size() >= with.size() && std::ranges::equal(text.first(with.size()), std::as_bytes(std::span(with)));
}

/// The library's part of a file and whether its checksum follows; without one it is all of the file.
Sealed unseal(std::span<const std::byte> bytes) {
  if (!begins(bytes, "\211HDF\r\n\032\n")) throw Error("is not an HDF5 file");
  const auto seal = bytes.last(std::min(seal_size, bytes.size()));
  const auto content = bytes.first(bytes.size() - seal.size());
  if (!begins(seal, seal_name)) return {bytes, false};
  if (!std::ranges::equal(seal, seal_of(content))) throw Error("is damaged: its checksum is wrong");
  return {content, true};
}

std::string bytes_of(const std::filesystem::path& path) {
  std::error_code unknown;  // then it is not a regular file to us
  if (!std::filesystem::exists(path, unknown)) throw Error("there is no such file");
  if (!std::filesystem::is_regular_file(path, unknown)) throw Error("is not a regular file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error("cannot be read");
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

Handle create_in_memory() {
  be_silent();
  static std::atomic<int> count = 0;  // files of the same name would be the same file to the library
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), "file");
  check(H5Pset_attr_creation_order(creation.id(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED), "file");
  return {H5Fcreate(fmt::format("new {}", count++).c_str(), H5F_ACC_TRUNC, creation.id(), in_memory().id()), "file"};
}

std::vector<std::byte> raw_image(const Handle& file) {
  check(H5Fflush(file.id(), H5F_SCOPE_GLOBAL), "file image");
  std::vector<std::byte> bytes(static_cast<std::size_t>(check(H5Fget_file_image(file.id(), nullptr, 0), "file image")));
  check(H5Fget_file_image(file.id(), bytes.data(), bytes.size()), "file image");
  return bytes;
}

Handle open_raw_image(std::span<const std::byte> bytes) {
  be_silent();
  static std::atomic<int> count = 0;
  const Handle access = in_memory();
  std::vector<std::byte> copy(bytes.begin(), bytes.end());  // the library asks for one that it may change, and copies it
  check(H5Pset_file_image(access.id(), copy.data(), copy.size()), "file image");
  return {H5Fopen(fmt::format("image {}", count++).c_str(), H5F_ACC_RDWR, access.id()), "cannot be opened"};
}

Handle open_unsealed(const std::filesystem::path& path) {
  be_silent();
  return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), "cannot be opened"};
}

Opened open_with_changes(std::span<const std::byte> bytes) { return copied_in_sandbox(unseal(bytes)); }

Opened open_with_changes(const std::filesystem::path& path) {
  const std::string bytes = bytes_of(path);
  return open_with_changes(std::as_bytes(std::span(bytes)));
}

namespace {

Handle without_alterations(Opened opened) {
  const auto& altered = opened.altered;
  if (altered.empty()) return std::move(opened.file);
  throw Error(fmt::format("has been altered by another program: {}{}", altered.front(),
                          altered.size() == 1 ? "" : fmt::format(" and {} more", altered.size() - 1)));
}

}  // namespace

Handle open_for_reading(const std::filesystem::path& path) { return without_alterations(open_with_changes(path)); }

Handle open_image(std::span<const std::byte> bytes) { return without_alterations(open_with_changes(bytes)); }

std::vector<std::byte> sealed(std::vector<std::byte> content) {
  const auto seal = seal_of(content);
  content.insert(content.end(), seal.begin(), seal.end());
  return content;
}

std::vector<std::byte> image(const Handle& file) {
  sign(file);
  return sealed(raw_image(file));
}

}  // namespace drape::results::hdf5
