#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "reference/reference.hpp"

namespace drape::reference {

/// What was read is not a reference file of the key.
class DamagedFile : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The bytes of a file: the key and the reference as CBOR [RFC 8949] under the names of their members, series of numbers as
/// typed arrays [RFC 8746], followed by an XXH3 checksum of all that. The layout has no version: the key holds a fingerprint of
/// this source.
std::string encode(std::string_view key, const Reference& reference);

/// The inverse. Throws DamagedFile if anything is not as encode() wrote it, or if the key is another.
Reference decode(std::string_view bytes, std::string_view key);

}  // namespace drape::reference
