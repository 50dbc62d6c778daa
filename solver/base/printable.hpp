#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Makes texts from outside (names of files, keys, values) fit for terminals and for files that users read.
namespace drape::base {

/// One line without anything that acts on a terminal or reorders what is shown: control characters, line breaks and invisible
/// formatting characters become \n, \r, \t or \uXXXX, bytes that are not UTF-8 become \xXX.
std::string printable(std::string_view text);

/// The same, but line feeds stay: of a text that is laid out in lines. JSON remains the same JSON.
std::string printable_lines(std::string_view text);

/// The first `most` characters of a UTF-8 text, and how long it is if that is not all.
std::string shortened(std::string text, std::size_t most);

/// A user's text as messages quote it: printable, at most 200 characters.
std::string quoted(std::string_view text);

/// Number of characters of a UTF-8 text: all bytes except those that continue one.
std::size_t characters(std::string_view text);

}  // namespace drape::base
