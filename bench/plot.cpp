#include "bench/plot.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace drape::bench {
namespace {

constexpr const char* interpreter = "/usr/bin/python3";  // Debian's own, which finds its matplotlib and h5py

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

std::string plot(std::string_view script, const std::filesystem::path& file) {
  const std::string path = fmt::format("{}/bench/{}", DRAPE_SOURCE_DIR, script), data = file.string();
  std::array<const char*, 4> arguments{interpreter, path.c_str(), data.c_str(), nullptr};
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return fmt::format("no plots: {}\n", std::strerror(errno));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int fd : {STDOUT_FILENO, STDERR_FILENO}) posix_spawn_file_actions_adddup2(&actions, ends[1], fd);
  posix_spawn_file_actions_addclose(&actions, ends[0]);
  pid_t child = 0;
  const int error =
      posix_spawn(&child, interpreter, &actions, nullptr, const_cast<char* const*>(arguments.data()), environ);  // NOLINT
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  std::string said = read_all(ends[0]);
  close(ends[0]);
  if (error != 0) return fmt::format("no plots: {}: {}\n", interpreter, std::strerror(error));
  int status = 0;
  waitpid(child, &status, 0);
  return status == 0 ? said : fmt::format("no plots: {} said '{}'\n", script, last_line(std::move(said)));
}

}  // namespace drape::bench
