#include <algorithm>
#include <array>

#include "results/file/hdf5_value.hpp"

namespace drape::results::hdf5 {
namespace {

using Pair = std::array<std::uint64_t, 2>;

void write_signature(const Handle& object, const std::vector<Pair>& pairs) {
  if (check(H5Aexists(object.id(), signature_name), signature_name) > 0)
    check(H5Adelete(object.id(), signature_name), signature_name);
  const std::array<hsize_t, 2> shape{pairs.size(), 2};
  const Handle space(H5Screate_simple(2, shape.data(), nullptr), signature_name);
  const Handle attribute(H5Acreate2(object.id(), signature_name, H5T_STD_U64LE, space.id(), H5P_DEFAULT, H5P_DEFAULT),
                         signature_name);
  check(H5Awrite(attribute.id(), H5T_NATIVE_UINT64, pairs.data()), signature_name);
}

void sign_object(const Handle& object, const std::string& path) {
  std::vector<Pair> pairs;
  for (const std::string& name : attributes(object)) {
    const std::string where = fmt::format("{}@{}", path, name);
    pairs.push_back(
        {key_of(where), hash_of(read_value(Handle(H5Aopen(object.id(), name.c_str(), H5P_DEFAULT), where), where))});
  }
  const bool dataset = H5Iget_type(object.id()) == H5I_DATASET;
  pairs.push_back({key_of(path), dataset ? hash_of(read_value(object, path)) : hash_of(links(object))});
  write_signature(object, pairs);
}

/// `depth`: of groups to which members are added; what is below is signed once.
void sign_below(const Handle& group, const std::string& path, int depth) {
  for (const std::string& name : links(group)) {
    const std::string where = fmt::format("{}/{}", path, name);
    const Handle object(H5Oopen(group.id(), name.c_str(), H5P_DEFAULT), where);
    if (depth <= 0 && check(H5Aexists(object.id(), signature_name), where) > 0) continue;
    if (H5Iget_type(object.id()) == H5I_GROUP) sign_below(object, where, depth - 1);
    sign_object(object, where);
  }
}

}  // namespace

void sign(const Handle& file) {
  const Handle root(H5Gopen2(file.id(), "/", H5P_DEFAULT), "/");
  sign_below(root, "", 1);
  sign_object(root, "");
}

Signature signature_of(const Handle& object) {
  if (check(H5Aexists(object.id(), signature_name), signature_name) == 0) return {};
  const Handle attribute(H5Aopen(object.id(), signature_name, H5P_DEFAULT), signature_name);
  const Handle type(H5Aget_type(attribute.id()), signature_name), space(H5Aget_space(attribute.id()), signature_name);
  const auto shape = shape_of(space, signature_name);
  if (H5Tequal(type.id(), H5T_STD_U64LE) <= 0 || shape.size() != 2 || shape[1] != 2) return {};
  std::vector<Pair> pairs(static_cast<std::size_t>(shape[0]));
  check(H5Aread(attribute.id(), H5T_NATIVE_UINT64, pairs.data()), signature_name);
  Signature signature;
  for (const auto& [key, hash] : pairs) signature[key] = hash;
  return signature;
}

}  // namespace drape::results::hdf5
