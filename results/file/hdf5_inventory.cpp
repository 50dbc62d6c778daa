#include "results/file/hdf5_value.hpp"

namespace drape::results::hdf5 {
namespace {

using Inventory = std::map<std::string, Item>;

void list_attributes(const Handle& object, const std::string& path, Inventory& all) {
  for (const std::string& name : attributes(object)) {
    const std::string where = fmt::format("{}@{}", path, name);
    const Value value = declaration(Handle(H5Aopen(object.id(), name.c_str(), H5P_DEFAULT), where), where);
    all[where] = {value.type, value.shape, {}};
  }
}

Item describe_dataset(const Handle& dataset, const std::string& path, const Inventory& all) {
  const Value value = declaration(dataset, path);
  const auto unit = all.find(path + "@unit");
  const bool readable = unit != all.end() && unit->second.type == "text" && unit->second.shape.empty();
  return {value.type, value.shape, readable ? read_text(dataset, "unit") : ""};
}

void list_members(const Handle& group, const std::string& path, Inventory& all) {
  for (const std::string& name : links(group)) {
    const std::string where = fmt::format("{}/{}", path, name);
    all[where].type = "other";
    H5L_info_t link;
    check(H5Lget_info(group.id(), name.c_str(), &link, H5P_DEFAULT), where);
    if (link.type != H5L_TYPE_HARD) continue;
    const Handle object(H5Oopen(group.id(), name.c_str(), H5P_DEFAULT), where);
    list_attributes(object, where, all);
    if (H5Iget_type(object.id()) == H5I_DATASET) all[where] = describe_dataset(object, where, all);
    if (H5Iget_type(object.id()) == H5I_GROUP) {
      all[where].type = "group";
      list_members(object, where, all);
    }
  }
}

}  // namespace

std::map<std::string, Item> inventory(const Handle& file) {
  Inventory all;
  list_attributes(file, "", all);
  list_members(file, "", all);
  return all;
}

std::vector<std::string> groups(const Handle& group) { return links(group); }

}  // namespace drape::results::hdf5
