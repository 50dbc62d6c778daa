#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace drape::verify {

/// A program as a user starts it, without a shell. Its standard input is empty.
struct Command {
  std::filesystem::path program;
  std::vector<std::string> arguments;
  std::filesystem::path folder;          ///< in which it runs
  std::vector<std::string> environment;  ///< "NAME=value", besides our own
  std::filesystem::path output;          ///< an existing file for its standard output; captured if empty
};

/// What a program has shown.
struct ProgramResult {
  int exit_code = 0;  ///< as in a shell: 128 + signal if it was killed
  std::string out;
  std::string err;
  std::size_t peak_memory = 0;  ///< [bytes], of the program or one that it has started, whichever took most
};

/// Runs a program to its end; its standard error is no terminal.
ProgramResult run_program(const Command& command);

/// A program that runs beside us, but not longer than this object lives.
class RunningProgram {
 public:
  explicit RunningProgram(const Command& command);
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;
  ~RunningProgram();

  void send(int signal) const;
  ProgramResult wait();

 private:
  struct Process;
  std::unique_ptr<Process> process_;
};

/// Runs a program with its standard error on a terminal of `columns` columns: to its end, or until the terminal has shown a
/// text, when it is terminated.
ProgramResult run_on_terminal(const Command& command, unsigned short columns, std::string_view until = {});

}  // namespace drape::verify
