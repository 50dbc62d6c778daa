#pragma once

#include <string>

namespace drape::bench {

/// What is said on standard error beside errors: nothing; progress, remarks, and how far long references are; also a line for
/// each thing that is done.
enum class Verbosity { quiet, usual, verbose };

/// That of this process.
Verbosity verbosity();
void set_verbosity(Verbosity verbosity);

/// Says a remark unless it is to be quiet.
void say_note(const std::string& remark);

}  // namespace drape::bench
