#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace drape::bench {

/// Bytes as text that a browser's atob() reads [RFC 4648, 4].
std::string base64(std::span<const std::byte> bytes);

/// The bytes of such a text. Throws std::invalid_argument if it is none.
std::vector<std::byte> bytes_of_base64(std::string_view text);

}  // namespace drape::bench
