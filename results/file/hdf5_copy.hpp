#pragma once

#include <span>

#include "results/file/hdf5.hpp"

namespace drape::results::hdf5 {

/// The library's part of a file, and whether a right checksum of it follows.
struct Sealed {
  std::span<const std::byte> content;
  bool sealed;
};

/// A copy of a file with all of it that is of the types that are written here. Only a process of its own lets the library
/// see that other: on hostile bytes it crashes, loops and takes all memory. Links that do not lead to a new object in the file,
/// and values of other types, stand there as "other". Throws Error if the file is stored in other files, declares more than it
/// stores or than `most_numbers` allows, or if that process does not end well.
Opened copied_in_sandbox(const Sealed& file);

/// [bytes] Limit of the memory that numbers and texts of a file may take.
std::size_t most_numbers(std::size_t file_size);

}  // namespace drape::results::hdf5
