#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace drape::results {

/// Whether what a row states comes to what was declared, predicted or asked for. From the best to the worst.
enum class Standing { met, open, missed };

/// The standing as files name it, for example "met".
std::string_view to_string(Standing standing);

/// Nothing if no standing has this name.
std::optional<Standing> standing_named(std::string_view name);

/// What a row comes to.
struct Verdict {
  Standing standing = Standing::open;
  std::string detail = {};  ///< for users: "2 as declared"

  bool operator==(const Verdict&) const = default;
};

/// Met or missed, with what to say of it.
inline Verdict check(bool holds, std::string met, std::string missed) {
  return holds ? Verdict{Standing::met, std::move(met)} : Verdict{Standing::missed, std::move(missed)};
}

/// "met: 2 as declared", or "met" without a detail; of an open one the detail alone: "no theory known".
std::string to_string(const Verdict& verdict);

}  // namespace drape::results
