#pragma once

#include <string>
#include <vector>

namespace drape::base {

/// What a program has said until its end.
struct ChildSaid {
  int exit_code = 0;  ///< as in a shell: 128 + signal if it was killed
  std::string out;
  std::string err;

  /// Why it failed, in one line: the signal that ended it, or the last line of `err`; empty if it did not fail.
  std::string failure() const;
};

/// Runs a program, found on PATH unless its name has a slash, with the words after its name as arguments. One that takes longer
/// than `seconds` is killed with its whole process group, as it is when a signal reaches us. Throws std::system_error: no
/// such file (there is no such program), timed out, interrupted.
ChildSaid run_child(std::vector<std::string> words, double seconds);

/// The most memory that this process has taken, in MB.
double peak_memory();

}  // namespace drape::base
