#pragma once

#include <string>
#include <string_view>

namespace drape::results {

/// Whether something is as it was wanted.
enum class Standing { met, open, missed };

/// The text of a verdict: "met: 2 as declared", "open: no theory known", "missed".
std::string verdict(Standing standing, std::string_view detail = "");

/// What a verdict says. Texts that begin with none of these words classify, such as "converges", and are open.
Standing standing(std::string_view verdict);

}  // namespace drape::results
