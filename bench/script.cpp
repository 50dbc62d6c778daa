#include "bench/script.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace drape::bench {
namespace {

constexpr const char* interpreter = "/usr/bin/python3";  // Debian's own, which finds its packages

std::string read_all(int fd) {
  std::string text;
  std::array<char, 4096> buffer;
  for (ssize_t n = 0; (n = read(fd, buffer.data(), buffer.size())) > 0;)
    text.append(buffer.data(), static_cast<std::size_t>(n));
  return text;
}

/// The last line of a text, which in a traceback says what happened.
std::string last_line(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace

ScriptResult run_script(std::string_view script, const std::vector<std::string>& arguments) {
  const std::string path = fmt::format("{}/bench/{}", DRAPE_SOURCE_DIR, script);
  std::vector<const char*> words{interpreter, path.c_str()};
  for (const std::string& argument : arguments) words.push_back(argument.c_str());
  words.push_back(nullptr);
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return {false, std::strerror(errno)};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int fd : {STDOUT_FILENO, STDERR_FILENO}) posix_spawn_file_actions_adddup2(&actions, ends[1], fd);
  posix_spawn_file_actions_addclose(&actions, ends[0]);
  pid_t child = 0;
  const int error =
      posix_spawn(&child, interpreter, &actions, nullptr, const_cast<char* const*>(words.data()), environ);  // NOLINT
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  std::string said = read_all(ends[0]);
  close(ends[0]);
  if (error != 0) return {false, fmt::format("{}: {}", interpreter, std::strerror(error))};
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status)) return {false, fmt::format("{} crashed ({})", script, strsignal(WTERMSIG(status)))};
  if (status != 0) return {false, last_line(std::move(said))};
  return {true, std::move(said)};
}

}  // namespace drape::bench
