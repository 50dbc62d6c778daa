#pragma once

#include <cstdint>

#include "results/file/hdf5_library.hpp"

namespace drape::results::hdf5 {

/// What an attribute or a dataset holds, if it is of a type that is written here; else only "other".
struct Value {
  std::string type;
  std::vector<std::uint64_t> shape;
  std::vector<std::byte> numbers;  ///< as they are in the file
  std::vector<std::string> texts;
};

/// Type and shape only.
Value declaration(const Handle& from, const std::string& path);

/// Throws Error if it cannot be read, or if a dataset has more than `most_text` bytes of text. What a dataset declares must be
/// known to be stored: its memory is taken first.
Value read_value(const Handle& from, const std::string& path, std::size_t most_text = SIZE_MAX);

void write_attribute(const Handle& object, const std::string& name, const Value& value);
void write_dataset(const Handle& group, const std::string& name, const Value& value);

/// Hash of type, shape and content.
std::uint64_t hash_of(const Value& value);

/// Attributes of an object, its content and the names of its members as it was when sign() saw it: hashes by the hash of a
/// path. Empty if it was not signed.
using Signature = std::map<std::uint64_t, std::uint64_t>;
Signature signature_of(const Handle& object);

/// The keys of a signature.
std::uint64_t key_of(const std::string& path);
std::uint64_t hash_of(const std::vector<std::string>& names);

}  // namespace drape::results::hdf5
