#pragma once

#include <string>
#include <vector>

namespace drape::bench {

/// A word as a shell takes it: quoted, unless it is plain.
std::string shell_word(const std::string& word);

/// The words of a line of such words.
std::vector<std::string> shell_words(const std::string& line);

}  // namespace drape::bench
