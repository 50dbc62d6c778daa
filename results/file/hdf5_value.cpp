#include "results/file/hdf5_value.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include "solver/base/hash.hpp"

namespace drape::results::hdf5 {
namespace {

struct NamedType {
  const char* name;
  hid_t (*in_file)();
};

constexpr std::array numbers{NamedType{"float64", [] { return H5T_IEEE_F64LE; }},
                             NamedType{"int32", [] { return H5T_STD_I32LE; }},
                             NamedType{"int64", [] { return H5T_STD_I64LE; }}};

bool is_attribute(const Handle& object) { return H5Iget_type(object.id()) == H5I_ATTR; }

Handle type_of(const Handle& from, const std::string& path) {
  return {is_attribute(from) ? H5Aget_type(from.id()) : H5Dget_type(from.id()), path};
}

Handle space_of(const Handle& from, const std::string& path) {
  return {is_attribute(from) ? H5Aget_space(from.id()) : H5Dget_space(from.id()), path};
}

std::string name_of(const Handle& type) {
  if (H5Tequal(type.id(), text_type().id()) > 0) return "text";
  for (const auto& [name, in_file] : numbers)
    if (H5Tequal(type.id(), in_file()) > 0) return name;
  return "other";
}

void read(const Handle& from, const Handle& type, void* values, const std::string& path, hid_t transfer = H5P_DEFAULT) {
  check(is_attribute(from) ? H5Aread(from.id(), type.id(), values)
                           : H5Dread(from.id(), type.id(), H5S_ALL, H5S_ALL, transfer, values),
        path);
}

/// For the library: memory for a text, from what is left of what texts may take.
void* take_memory(std::size_t size, void* left) {
  auto& bytes = *static_cast<std::size_t*>(left);
  if (size > bytes) return nullptr;
  bytes -= size;
  return std::malloc(size);
}

void free_memory(void* memory, void*) { std::free(memory); }

std::vector<std::string> read_texts(const Handle& from, std::size_t count, const std::string& path, std::size_t most) {
  const Handle type = text_type(), space = space_of(from, path), transfer(H5Pcreate(H5P_DATASET_XFER), path);
  check(H5Pset_vlen_mem_manager(transfer.id(), take_memory, &most, free_memory, nullptr), path);
  most += std::min(count, SIZE_MAX - most);  // each has a zero at its end
  if (count == 0) return {};                 // H5Dvlen_reclaim() wants memory even of no texts
  std::vector<char*> pointers(count);
  read(from, type, pointers.data(), path, transfer.id());
  std::vector<std::string> texts;
  for (const char* text : pointers) texts.emplace_back(text ? text : "");
  check(H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, pointers.data()), path);
  return texts;
}

Handle space_for(const Value& value, const std::string& name) {
  const std::vector<hsize_t> dimensions(value.shape.begin(), value.shape.end());
  const int rank = static_cast<int>(dimensions.size());
  return {rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, dimensions.data(), nullptr), name};
}

Handle type_for(const Value& value) {
  if (value.type == "text") return text_type();
  const auto named = std::ranges::find(numbers, value.type, [](const NamedType& type) { return std::string(type.name); });
  return {H5Tcopy(named->in_file()), value.type};
}

/// Calls write with what the library takes the value from.
void with_content(const Value& value, const auto& write) {
  if (value.type != "text") return write(value.numbers.data());
  std::vector<const char*> texts;
  for (const std::string& text : value.texts) texts.push_back(text.c_str());
  write(texts.data());
}

}  // namespace

Value declaration(const Handle& from, const std::string& path) {
  const Handle type = type_of(from, path), space = space_of(from, path);
  const bool nothing = H5Sget_simple_extent_type(space.id()) == H5S_NULL;
  Value value{nothing ? "other" : name_of(type), shape_of(space, path), {}, {}};
  if (is_attribute(from) && !value.shape.empty()) value.type = "other";  // ours are single values
  return value;
}

Value read_value(const Handle& from, const std::string& path, std::size_t most_text) {
  Value value = declaration(from, path);
  if (value.type == "other") return value;
  const Handle type = type_of(from, path), space = space_of(from, path);
  const auto count = static_cast<std::size_t>(check(H5Sget_simple_extent_npoints(space.id()), path));
  if (value.type == "text") {
    value.texts = read_texts(from, count, path, most_text);
  } else {
    value.numbers.resize(count * H5Tget_size(type.id()));
    read(from, type, value.numbers.data(), path);
  }
  return value;
}

void write_attribute(const Handle& object, const std::string& name, const Value& value) {
  const Handle type = type_for(value), space = space_for(value, name);
  const Handle attribute(H5Acreate2(object.id(), name.c_str(), type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), name);
  with_content(value, [&](const void* content) { check(H5Awrite(attribute.id(), type.id(), content), name); });
}

void write_dataset(const Handle& group, const std::string& name, const Value& value) {
  const Handle type = type_for(value), space = space_for(value, name);
  const Handle dataset(H5Dcreate2(group.id(), name.c_str(), type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                       name);
  with_content(value, [&](const void* content) {
    check(H5Dwrite(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, content), name);
  });
}

std::uint64_t key_of(const std::string& path) { return base::hash(path); }

std::uint64_t hash_of(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += name + '\0';
  return key_of(all);
}

std::uint64_t hash_of(const Value& value) {
  std::vector<std::string> parts{value.type};
  for (const std::uint64_t extent : value.shape) parts.push_back(std::to_string(extent));
  parts.insert(parts.end(), value.texts.begin(), value.texts.end());
  return base::hash({reinterpret_cast<const char*>(value.numbers.data()), value.numbers.size()}, hash_of(parts));
}

}  // namespace drape::results::hdf5
