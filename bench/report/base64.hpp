#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace drape::bench {

/// Bytes as text that a browser's atob() reads [RFC 4648, 4].
std::string base64(std::span<const std::byte> bytes);

}  // namespace drape::bench
