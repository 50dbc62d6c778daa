#include "solver/base/hash.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>

namespace drape::base {

std::uint64_t hash(std::string_view bytes, std::uint64_t seed) {
  return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);
}

std::string hash_text(std::string_view bytes) { return fmt::format("{:016x}", hash(bytes)); }

std::string long_hash_text(std::string_view text) {
  const XXH128_hash_t value = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", value.high64, value.low64);
}

LongHash long_hash(std::span<const std::byte> bytes) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(bytes.data(), bytes.size()));
  LongHash digest{};
  std::ranges::copy(std::as_bytes(std::span(canonical.digest)), digest.begin());
  return digest;
}

}  // namespace drape::base
