#pragma once

#include <map>
#include <string>
#include <vector>

#include "verify/support/run_program.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify {

using Words = std::vector<std::string>;

Words operator+(Words a, const Words& b);

/// The program bench_integrators in a new and empty folder, with a cache of references of its own.
class BenchIntegrators {
 public:
  BenchIntegrators();

  std::filesystem::path folder() const { return temporary_ / "work"; }
  std::filesystem::path cache() const { return temporary_ / "cache"; }

  Command command(const Words& arguments) const;

  ProgramResult run(const Words& arguments) const { return run_program(command(arguments)); }

  /// What it prints; expects it to succeed without a word on standard error but how far a reference has come.
  std::string output(const Words& arguments) const;

  void write(const std::string& name, const std::string& content) const;

  /// All that is in the folder and its folders: contents of files by their path; a folder's path ends in '/'.
  std::map<std::string, std::string> files() const;

 private:
  base::TemporaryFolder temporary_;
};

std::string joined(const Words& words, const char* separator);

Words split(const std::string& text, char separator);

Words lines(const std::string& text);

/// A line of CSV by the names of its columns.
using Row = std::map<std::string, std::string>;

double number(const Row& row, const std::string& column);

/// CSV without quotes.
std::vector<Row> parse_csv(const std::string& text);

}  // namespace drape::verify
