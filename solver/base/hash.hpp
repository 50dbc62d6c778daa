#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace drape::base {

/// XXH3, 64 bits, of a text or of the bytes of a file.
std::uint64_t hash(std::string_view bytes, std::uint64_t seed = 0);

/// The same as 16 hexadecimal digits.
std::string hash_text(std::string_view bytes);

/// XXH3, 128 bits, as 32 hexadecimal digits: the name of something that its text determines.
std::string long_hash_text(std::string_view text);

/// XXH3, 128 bits, the most significant byte first.
using LongHash = std::array<std::byte, 16>;
LongHash long_hash(std::span<const std::byte> bytes);

}  // namespace drape::base
