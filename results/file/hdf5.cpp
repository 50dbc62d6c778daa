#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "results/file/hdf5_library.hpp"

namespace drape::results::hdf5 {
namespace {

/// For the library's iterations: appends a name to a list.
template <class Info>
herr_t append_name(hid_t, const char* name, const Info*, void* names) {
  static_cast<std::vector<std::string>*>(names)->push_back(name);
  return 0;
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

std::string description_of(const std::string& name) { return name + ".description"; }

}  // namespace

Handle::Handle(std::int64_t id, const std::string& what) : id_(check(id, what)) {}
Handle::Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)) {}
Handle::~Handle() {
  if (id_ != H5I_INVALID_HID) H5Idec_ref(id_);
}

std::string innermost_error() {
  std::string description = "no reason given";
  const auto take = [](unsigned, const H5E_error2_t* error, void* text) -> herr_t {
    if (error->desc) *static_cast<std::string*>(text) = error->desc;
    return 1;  // the first is enough
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take, &description);
  return description;
}

void be_silent() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), "text type");
  check(H5Tset_size(type.id(), H5T_VARIABLE), "text type");
  check(H5Tset_cset(type.id(), H5T_CSET_UTF8), "text type");
  return type;
}

std::vector<std::string> links(const Handle& group) {
  std::vector<std::string> names;
  check(H5Literate(group.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, append_name<H5L_info_t>, &names), "members");
  return names;
}

/// The signature, and what the library keeps of scales of dimensions.
constexpr std::string_view unlisted[] = {signature_name, "CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST"};

std::vector<std::string> attributes(const Handle& object, H5_index_t order) {
  std::vector<std::string> names;
  check(H5Aiterate2(object.id(), order, H5_ITER_INC, nullptr, append_name<H5A_info_t>, &names), "attributes");
  std::erase_if(names, [](const std::string& name) { return std::ranges::find(unlisted, name) != std::end(unlisted); });
  return names;
}

std::vector<std::uint64_t> shape_of(const Handle& space, const std::string& name) {
  std::vector<hsize_t> shape(static_cast<std::size_t>(check(H5Sget_simple_extent_ndims(space.id()), name)));
  check(H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr), name);
  return {shape.begin(), shape.end()};
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
  std::vector<std::string> names = attributes(object, H5_INDEX_CRT_ORDER);
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
  if (texts.empty()) return {};  // H5Dvlen_reclaim() wants memory even of no texts
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
