#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

/// The little of HDF5 that we use, with exceptions and handles that close themselves. Only hdf5.cpp knows the library.
///
/// Single texts are kept in attributes, since h5py shows these as str, and described by an attribute of their own:
/// `a.description` for `a`. Numbers and lists of texts are kept in datasets with the attributes `unit` and `description`.
namespace drape::results::hdf5 {

/// Says what failed and why, but not in which file.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Owns a file, a group or any other object of the library.
class Handle {
 public:
  /// Throws Error, naming `what`, if the id is not valid.
  Handle(std::int64_t id, const std::string& what);
  Handle(Handle&& other) noexcept;
  Handle& operator=(Handle&&) = delete;
  ~Handle();
  std::int64_t id() const { return id_; }

 private:
  std::int64_t id_;
};

/// A file that exists in memory only. Its root remembers the order in which its attributes were written.
Handle create_in_memory();

/// What is in a file of ours, in memory, to be read and changed there, and what another program has done to the file: paths of
/// what it has added, which is not in the copy, and of what it has altered or taken out (a path that ends in '/' or '@':
/// members or attributes of that object are missing). A file that is as image() gave it has neither.
struct Opened {
  Handle file;
  std::vector<std::string> added, altered;
};

/// Throws Error if it has been truncated or damaged or is none of ours. The library sees it in a process of its own only, with
/// limits, as it crashes on some damaged files.
Opened open_with_changes(const std::filesystem::path& path);
Opened open_with_changes(std::span<const std::byte> bytes);

/// The same, of a file or its bytes; throws Error if something is altered, but not if something is added.
Handle open_for_reading(const std::filesystem::path& path);
Handle open_image(std::span<const std::byte> bytes);

/// A file without a checksum that one of our own scripts has just had the library write. Not for files of users: see above.
Handle open_unsealed(const std::filesystem::path& path);

/// What the file is on disk: the library's image, which other programs can read, followed by a checksum of it.
std::vector<std::byte> image(const Handle& file);

/// The library's bytes followed by a checksum of them.
std::vector<std::byte> sealed(std::vector<std::byte> content);

/// Notes checksums of each object and its attributes with it, for files that other programs change. To the file, its groups
/// and theirs members may have been added since; what is below is as it was when it was signed. Part of image().
void sign(const Handle& file);

Handle create_group(const Handle& parent, const std::string& name, const std::string& description);
Handle open_group(const Handle& parent, const std::string& name);
bool has(const Handle& parent, const std::string& name);
void remove(const Handle& parent, const std::string& name);

void write_text(const Handle& object, const std::string& name, const std::string& value);
void write_described_text(const Handle& object, const std::string& name, const std::string& value,
                          const std::string& description);

/// Writes another value to a text that is there; it keeps its place among the attributes.
void rewrite_text(const Handle& object, const std::string& name, const std::string& value);
std::string read_text(const Handle& object, const std::string& name);
std::string read_description(const Handle& object, const std::string& name);

/// Names of the texts of an object that have a description, in the order they were written.
std::vector<std::string> described_texts(const Handle& object);

/// An integer as an attribute of its own.
void write_integer(const Handle& object, const std::string& name, int value);
int read_integer(const Handle& object, const std::string& name);

/// Number: double, int or std::int64_t. Shape {} is a single number. A '/' in the name makes groups.
template <class Number>
void write_numbers(const Handle& group, const std::string& name, const Number* values, std::vector<std::uint64_t> shape,
                   const std::string& unit, const std::string& description);

/// The same, compressed (shuffle and deflate), each of the first dimension's rows a chunk of its own.
template <class Number>
void write_frames(const Handle& group, const std::string& name, const Number* values, std::vector<std::uint64_t> shape,
                  const std::string& unit, const std::string& description);

/// All numbers of a dataset, row by row.
template <class Number>
std::vector<Number> read_numbers(const Handle& group, const std::string& name);

/// Throws Error unless the dataset holds exactly one number.
template <class Number>
Number read_number(const Handle& group, const std::string& name);

void write_texts(const Handle& group, const std::string& name, const std::vector<std::string>& values,
                 const std::string& description);

/// All texts of a dataset; throws Error if it holds something else.
std::vector<std::string> read_texts(const Handle& group, const std::string& name);

/// Names a dimension of a dataset by another dataset of the group, its scale, which has an entry for each place along it.
void name_dimension(const Handle& group, const std::string& dataset, unsigned dimension, const std::string& scale);

/// A dataset's name in its group (a path, if it is in a group of the group), unit and description.
struct DatasetInfo {
  std::string name;
  std::string unit;
  std::string description;
};

/// An object as the file has it. `type` is one of those that are written here, "text", "float64", "int32" or "int64"; "group";
/// or "other". The shape {} is a single value; `unit` is the attribute of a dataset, if there is one.
struct Item {
  std::string type;
  std::vector<std::uint64_t> shape;
  std::string unit;
};

/// All that is in a file, by path; the attribute `a` of an object is `path@a`. Links that lead elsewhere are "other".
std::map<std::string, Item> inventory(const Handle& file);

/// Names of all groups in a group, sorted.
std::vector<std::string> groups(const Handle& group);

/// All datasets in a group and in its groups, sorted by name.
std::vector<DatasetInfo> datasets(const Handle& group);

}  // namespace drape::results::hdf5
