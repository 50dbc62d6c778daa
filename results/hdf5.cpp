#include "results/hdf5.hpp"

#include <fmt/format.h>
#include <hdf5.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <concepts>
#include <fstream>
#include <iterator>
#include <string_view>
#include <type_traits>
#include <utility>

namespace drape::results::hdf5 {
namespace {

static_assert(std::is_same_v<hid_t, std::int64_t>);

/// The most specific description on the library's error stack.
std::string innermost_error() {
  std::string description = "no reason given";
  const auto take = [](unsigned, const H5E_error2_t* error, void* text) -> herr_t {
    if (error->desc) *static_cast<std::string*>(text) = error->desc;
    return 1;  // the first is enough
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take, &description);
  return description;
}

/// Passes on what a function of the library returned: all of them say with a negative number that they failed.
template <std::signed_integral Result>
Result check(Result result, const std::string& what) {
  if (result < 0) throw Error(fmt::format("{}: {}", what, innermost_error()));
  return result;
}

/// The library must not print its errors: they are in our exceptions.
void be_silent() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

/// UTF-8 of any length.
Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), "text type");
  check(H5Tset_size(type.id(), H5T_VARIABLE), "text type");
  check(H5Tset_cset(type.id(), H5T_CSET_UTF8), "text type");
  return type;
}

/// The types in memory and, the same on every machine, in the file.
struct Types {
  hid_t memory;
  hid_t file;
};

template <class Number>
Types types() {
  if constexpr (std::is_same_v<Number, double>) return {H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE};
  if constexpr (std::is_same_v<Number, int>) return {H5T_NATIVE_INT, H5T_STD_I32LE};
  if constexpr (std::is_same_v<Number, std::int64_t>) return {H5T_NATIVE_INT64, H5T_STD_I64LE};
}

void write_attribute(const Handle& object, const std::string& name, Types types, const void* value) {
  const Handle space(H5Screate(H5S_SCALAR), name);
  const Handle attribute(H5Acreate2(object.id(), name.c_str(), types.file, space.id(), H5P_DEFAULT, H5P_DEFAULT), name);
  check(H5Awrite(attribute.id(), types.memory, value), name);
}

/// Reads an attribute that holds one value.
void read_attribute(const Handle& object, const std::string& name, hid_t type, void* value) {
  const Handle attribute(H5Aopen(object.id(), name.c_str(), H5P_DEFAULT), name);
  const Handle space(H5Aget_space(attribute.id()), name);
  if (check(H5Sget_simple_extent_npoints(space.id()), name) != 1) throw Error(name + " must be a single value");
  check(H5Aread(attribute.id(), type, value), name);
}

/// Access to files that are in memory and stay there.
Handle in_memory() {
  constexpr std::size_t growth = 1 << 20;  // [bytes]
  Handle access(H5Pcreate(H5P_FILE_ACCESS), "file");
  check(H5Pset_fapl_core(access.id(), growth, /*backing_store=*/false), "file");
  return access;
}

std::string description_of(const std::string& name) { return name + ".description"; }

/// For the library's iterations: appends a name to a list.
template <class Info>
herr_t append_name(hid_t, const char* name, const Info*, void* names) {
  static_cast<std::vector<std::string>*>(names)->push_back(name);
  return 0;
}

}  // namespace

Handle::Handle(std::int64_t id, const std::string& what) : id_(check(id, what)) {}
Handle::Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)) {}
Handle::~Handle() {
  if (id_ != H5I_INVALID_HID) H5Idec_ref(id_);
}

Handle create_in_memory(const std::filesystem::path& name) {
  be_silent();
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), "file");
  check(H5Pset_attr_creation_order(creation.id(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED), "file");
  return {H5Fcreate(name.c_str(), H5F_ACC_TRUNC, creation.id(), in_memory().id()), "file"};
}

namespace {

/// What follows the library's part of a file: who wrote it, and the checksum of that part.
constexpr std::string_view seal_name = "drape: XXH3-128\n";
constexpr std::size_t seal_size = seal_name.size() + sizeof(XXH128_canonical_t);

std::array<std::byte, seal_size> seal_of(std::span<const std::byte> content) {
  XXH128_canonical_t hash;
  XXH128_canonicalFromHash(&hash, XXH3_128bits(content.data(), content.size()));
  std::array<std::byte, seal_size> seal{};
  const auto after_name = std::ranges::copy(std::as_bytes(std::span(seal_name)), seal.begin()).out;
  std::ranges::copy(std::as_bytes(std::span(hash.digest)), after_name);
  return seal;
}

/// The library's part of a file.
std::span<const std::byte> unseal(std::span<const std::byte> bytes) {
  constexpr std::string_view signature = "\211HDF\r\n\032\n";
  const auto begins = [](std::span<const std::byte> text, std::string_view with) {
    return text.size() >= with.size() && std::ranges::equal(text.first(with.size()), std::as_bytes(std::span(with)));
  };
  if (!begins(bytes, signature)) throw Error("is no HDF5 file");
  const auto seal = bytes.last(std::min(seal_size, bytes.size()));
  const auto content = bytes.first(bytes.size() - seal.size());
  if (!begins(seal, seal_name))
    throw Error("has been truncated, or is of another program or an older version: there is no checksum at its end");
  if (!std::ranges::equal(seal, seal_of(content))) throw Error("is damaged: its checksum is wrong");
  return content;
}

}  // namespace

Handle open_unsealed(const std::filesystem::path& path) {
  be_silent();
  return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), "cannot be opened"};
}

Handle open_for_reading(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error("cannot be read");
  const std::string bytes(std::istreambuf_iterator<char>(stream), {});
  return open_image(std::as_bytes(std::span(bytes)));
}

Handle open_image(std::span<const std::byte> bytes) {
  be_silent();
  static std::atomic<int> count = 0;  // files of the same name would be the same file to the library
  const auto content = unseal(bytes);
  std::vector<std::byte> copy(content.begin(), content.end());  // the library asks for one that it may change, and copies it
  const Handle access = in_memory();
  check(H5Pset_file_image(access.id(), copy.data(), copy.size()), "file image");
  return {H5Fopen(fmt::format("image {}", count++).c_str(), H5F_ACC_RDWR, access.id()), "cannot be opened"};
}

std::vector<std::byte> image(const Handle& file) {
  check(H5Fflush(file.id(), H5F_SCOPE_GLOBAL), "file image");
  std::vector<std::byte> bytes(static_cast<std::size_t>(check(H5Fget_file_image(file.id(), nullptr, 0), "file image")));
  check(H5Fget_file_image(file.id(), bytes.data(), bytes.size()), "file image");
  const auto seal = seal_of(bytes);
  bytes.insert(bytes.end(), seal.begin(), seal.end());
  return bytes;
}

Handle create_group(const Handle& parent, const std::string& name, const std::string& description) {
  Handle group(H5Gcreate2(parent.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), name);
  write_text(group, "description", description);
  return group;
}

Handle open_group(const Handle& parent, const std::string& name) {
  return {H5Gopen2(parent.id(), name.c_str(), H5P_DEFAULT), name};
}

bool has(const Handle& parent, const std::string& name) {
  return check(H5Lexists(parent.id(), name.c_str(), H5P_DEFAULT), name) > 0;
}

void remove(const Handle& parent, const std::string& name) { check(H5Ldelete(parent.id(), name.c_str(), H5P_DEFAULT), name); }

void write_text(const Handle& object, const std::string& name, const std::string& value) {
  const Handle type = text_type();
  const char* text = value.c_str();
  write_attribute(object, name, {type.id(), type.id()}, &text);
}

void write_described_text(const Handle& object, const std::string& name, const std::string& value,
                          const std::string& description) {
  write_text(object, name, value);
  write_text(object, description_of(name), description);
}

void rewrite_text(const Handle& object, const std::string& name, const std::string& value) {
  const Handle attribute(H5Aopen(object.id(), name.c_str(), H5P_DEFAULT), name), type = text_type();
  const char* text = value.c_str();
  check(H5Awrite(attribute.id(), type.id(), &text), name);
}

std::string read_text(const Handle& object, const std::string& name) {
  const Handle type = text_type();
  char* text = nullptr;
  read_attribute(object, name, type.id(), &text);
  std::string value = text ? text : "";
  H5free_memory(text);
  return value;
}

std::string read_description(const Handle& object, const std::string& name) { return read_text(object, description_of(name)); }

std::vector<std::string> described_texts(const Handle& object) {
  std::vector<std::string> names;
  check(H5Aiterate2(object.id(), H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, append_name<H5A_info_t>, &names), "attributes");
  std::erase_if(names,
                [&](const auto& name) { return check(H5Aexists(object.id(), description_of(name).c_str()), name) == 0; });
  return names;
}

void write_integer(const Handle& object, const std::string& name, int value) {
  write_attribute(object, name, types<int>(), &value);
}

int read_integer(const Handle& object, const std::string& name) {
  int value = 0;
  read_attribute(object, name, types<int>().memory, &value);
  return value;
}

namespace {

/// A new dataset with its unit and description; `creation`: how it is laid out in the file.
void write_dataset(const Handle& group, const std::string& name, Types types_of_values, const void* values,
                   const std::vector<std::uint64_t>& shape, const std::string& unit, const std::string& description,
                   hid_t creation = H5P_DEFAULT) {
  const std::vector<hsize_t> dimensions(shape.begin(), shape.end());
  const int rank = static_cast<int>(shape.size());
  const Handle space(rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, dimensions.data(), nullptr), name);
  const Handle links(H5Pcreate(H5P_LINK_CREATE), name);
  check(H5Pset_create_intermediate_group(links.id(), 1), name);
  const Handle dataset(
      H5Dcreate2(group.id(), name.c_str(), types_of_values.file, space.id(), links.id(), creation, H5P_DEFAULT), name);
  check(H5Dwrite(dataset.id(), types_of_values.memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), name);
  write_text(dataset, "unit", unit);
  write_text(dataset, "description", description);
}

}  // namespace

template <class Number>
void write_numbers(const Handle& group, const std::string& name, const Number* values, std::vector<std::uint64_t> shape,
                   const std::string& unit, const std::string& description) {
  write_dataset(group, name, types<Number>(), values, shape, unit, description);
}

template <class Number>
void write_frames(const Handle& group, const std::string& name, const Number* values, std::vector<std::uint64_t> shape,
                  const std::string& unit, const std::string& description) {
  constexpr unsigned level = 4;
  std::vector<hsize_t> chunk(shape.begin(), shape.end());
  chunk.front() = 1;
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), name);
  check(H5Pset_chunk(creation.id(), static_cast<int>(chunk.size()), chunk.data()), name);
  check(H5Pset_shuffle(creation.id()), name);
  check(H5Pset_deflate(creation.id(), level), name);
  write_dataset(group, name, types<Number>(), values, shape, unit, description, creation.id());
}

void write_texts(const Handle& group, const std::string& name, const std::vector<std::string>& values,
                 const std::string& description) {
  const Handle type = text_type();
  std::vector<const char*> texts;
  for (const std::string& value : values) texts.push_back(value.c_str());
  write_dataset(group, name, {type.id(), type.id()}, texts.data(), {texts.size()}, "", description);
}

std::vector<std::string> read_texts(const Handle& group, const std::string& name) {
  const Handle dataset(H5Dopen2(group.id(), name.c_str(), H5P_DEFAULT), name);
  const Handle space(H5Dget_space(dataset.id()), name), stored(H5Dget_type(dataset.id()), name), type = text_type();
  if (H5Tis_variable_str(stored.id()) <= 0) throw Error(name + " must be a list of texts");
  std::vector<char*> texts(static_cast<std::size_t>(check(H5Sget_simple_extent_npoints(space.id()), name)));
  check(H5Dread(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data()), name);
  std::vector<std::string> values;
  for (char* text : texts) values.emplace_back(text ? text : "");
  check(H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, texts.data()), name);
  return values;
}

template <class Number>
std::vector<Number> read_numbers(const Handle& group, const std::string& name) {
  const Handle dataset(H5Dopen2(group.id(), name.c_str(), H5P_DEFAULT), name);
  const Handle space(H5Dget_space(dataset.id()), name);
  std::vector<Number> values(static_cast<std::size_t>(check(H5Sget_simple_extent_npoints(space.id()), name)));
  check(H5Dread(dataset.id(), types<Number>().memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name);
  return values;
}

template <class Number>
Number read_number(const Handle& group, const std::string& name) {
  const auto values = read_numbers<Number>(group, name);
  if (values.size() != 1) throw Error(name + " must be a single number");
  return values.front();
}

namespace {

std::string name_of(const Handle& type) {
  const auto is = [&](hid_t other) { return H5Tequal(type.id(), other) > 0; };
  if (is(text_type().id())) return "text";
  if (is(H5T_IEEE_F64LE)) return "float64";
  if (is(H5T_STD_I32LE)) return "int32";
  if (is(H5T_STD_I64LE)) return "int64";
  return "other";
}

std::vector<std::uint64_t> shape_of(const Handle& space, const std::string& name) {
  std::vector<hsize_t> shape(static_cast<std::size_t>(check(H5Sget_simple_extent_ndims(space.id()), name)));
  check(H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr), name);
  return {shape.begin(), shape.end()};
}

using Inventory = std::map<std::string, Item>;

void list_attributes(const Handle& object, const std::string& path, Inventory& all) {
  std::vector<std::string> names;
  check(H5Aiterate2(object.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, append_name<H5A_info_t>, &names), "attributes");
  for (const std::string& name : names) {
    const Handle attribute(H5Aopen(object.id(), name.c_str(), H5P_DEFAULT), name);
    const Handle type(H5Aget_type(attribute.id()), name), space(H5Aget_space(attribute.id()), name);
    all[fmt::format("{}@{}", path, name)] = {name_of(type), shape_of(space, name), {}};
  }
}

Item describe_dataset(const Handle& dataset, const std::string& path, const Inventory& all) {
  const Handle type(H5Dget_type(dataset.id()), path), space(H5Dget_space(dataset.id()), path);
  const auto unit = all.find(path + "@unit");
  const bool readable = unit != all.end() && unit->second.type == "text" && unit->second.shape.empty();
  return {name_of(type), shape_of(space, path), readable ? read_text(dataset, "unit") : ""};
}

void list_members(const Handle& group, const std::string& path, int depth, Inventory& all) {
  constexpr int deepest = 8;  // groups of a damaged file may contain themselves
  std::vector<std::string> names;
  check(H5Literate(group.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, append_name<H5L_info_t>, &names), "members");
  for (const std::string& name : names) {
    const std::string where = fmt::format("{}/{}", path, name);
    all[where].type = "other";
    H5L_info_t link;
    check(H5Lget_info(group.id(), name.c_str(), &link, H5P_DEFAULT), name);
    if (link.type != H5L_TYPE_HARD) continue;
    const Handle object(H5Oopen(group.id(), name.c_str(), H5P_DEFAULT), where);
    list_attributes(object, where, all);
    if (H5Iget_type(object.id()) == H5I_DATASET) all[where] = describe_dataset(object, where, all);
    if (H5Iget_type(object.id()) == H5I_GROUP) {
      all[where].type = "group";
      if (depth < deepest) list_members(object, where, depth + 1, all);
    }
  }
}

}  // namespace

std::map<std::string, Item> inventory(const Handle& file) {
  Inventory all;
  list_attributes(file, "", all);
  list_members(file, "", 0, all);
  return all;
}

std::vector<std::string> groups(const Handle& group) {
  std::vector<std::string> names;
  check(H5Literate(group.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, append_name<H5L_info_t>, &names), "list of groups");
  return names;
}

std::vector<DatasetInfo> datasets(const Handle& group) {
  std::vector<std::string> names;
  check(H5Lvisit(group.id(), H5_INDEX_NAME, H5_ITER_INC, append_name<H5L_info_t>, &names), "list of datasets");
  std::vector<DatasetInfo> infos;
  for (const std::string& name : names) {
    const Handle object(H5Oopen(group.id(), name.c_str(), H5P_DEFAULT), name);
    if (H5Iget_type(object.id()) == H5I_DATASET)
      infos.push_back({name, read_text(object, "unit"), read_text(object, "description")});
  }
  return infos;
}

template void write_numbers(const Handle&, const std::string&, const double*, std::vector<std::uint64_t>, const std::string&,
                            const std::string&);
template void write_numbers(const Handle&, const std::string&, const int*, std::vector<std::uint64_t>, const std::string&,
                            const std::string&);
template void write_numbers(const Handle&, const std::string&, const std::int64_t*, std::vector<std::uint64_t>,
                            const std::string&, const std::string&);
template void write_frames(const Handle&, const std::string&, const double*, std::vector<std::uint64_t>, const std::string&,
                           const std::string&);
template void write_frames(const Handle&, const std::string&, const int*, std::vector<std::uint64_t>, const std::string&,
                           const std::string&);
template std::vector<double> read_numbers(const Handle&, const std::string&);
template std::vector<int> read_numbers(const Handle&, const std::string&);
template int read_number(const Handle&, const std::string&);
template double read_number(const Handle&, const std::string&);
template std::int64_t read_number(const Handle&, const std::string&);

}  // namespace drape::results::hdf5
