#pragma once

#include <fmt/format.h>
#include <hdf5.h>

#include <concepts>
#include <string>
#include <type_traits>
#include <vector>

#include "results/file/hdf5.hpp"

/// What the sources hdf5*.cpp share of the library; no other source includes it.
namespace drape::results::hdf5 {

static_assert(std::is_same_v<hid_t, std::int64_t>);

/// The most specific description on the library's error stack.
std::string innermost_error();

/// Passes on what a function of the library returned: all of them say with a negative number that they failed.
template <std::signed_integral Result>
Result check(Result result, const std::string& what) {
  if (result < 0) throw Error(fmt::format("{}: {}", what, innermost_error()));
  return result;
}

/// The library must not print its errors: they are in our exceptions.
void be_silent();

/// UTF-8 of any length.
Handle text_type();

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

/// The attribute with the checksums of an object.
inline constexpr const char* signature_name = "checksums";

/// Names of the links of a group or of the attributes of an object, sorted; without the attributes that sign() and
/// name_dimension() make, which say nothing of their own.
std::vector<std::string> links(const Handle& group);
std::vector<std::string> attributes(const Handle& object, H5_index_t order = H5_INDEX_NAME);

std::vector<std::uint64_t> shape_of(const Handle& space, const std::string& name);

/// The library's own bytes, without our checksum, and a file of such bytes in memory.
std::vector<std::byte> raw_image(const Handle& file);
Handle open_raw_image(std::span<const std::byte> bytes);

}  // namespace drape::results::hdf5
