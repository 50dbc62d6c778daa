#include "solver/base/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "solver/base/descriptor.hpp"

namespace drape::base {
namespace {

[[noreturn]] void fail() {
  if (errno == ENOENT) throw UnreadableFile("there is no such file");
  throw UnreadableFile("cannot be read (" + std::generic_category().message(errno) + ")");
}

void check(const struct stat& status, std::uintmax_t most_bytes) {
  if (S_ISDIR(status.st_mode)) throw UnreadableFile("is a folder");
  if (!S_ISREG(status.st_mode)) throw UnreadableFile("is a device or pipe, not a regular file");
  if (const auto size = static_cast<std::uintmax_t>(status.st_size); size > most_bytes)
    throw UnreadableFile("has " + in_megabytes(size) + ", more than " + in_megabytes(most_bytes));
}

}  // namespace

void require_input_file(const std::filesystem::path& file, std::uintmax_t most_bytes) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) fail();
  check(status, most_bytes);
}

std::string content_of(const std::filesystem::path& file, std::uintmax_t most_bytes) {
  require_input_file(file, most_bytes);                                                       // opening a device may act on it
  const Descriptor opened(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK));  // a pipe would wait for a writer
  if (opened.fd < 0) fail();
  struct stat status {};
  if (fstat(opened.fd, &status) != 0) fail();
  check(status, most_bytes);
  std::string bytes(static_cast<std::size_t>(status.st_size) + 1, '\0');  // one more shows the end
  std::size_t read_bytes = 0;
  for (;;) {
    if (read_bytes == bytes.size()) bytes.resize(2 * bytes.size());  // it has grown
    const ssize_t got = read(opened.fd, bytes.data() + read_bytes, bytes.size() - read_bytes);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail();
    if (got == 0) break;
    read_bytes += static_cast<std::size_t>(got);
    if (read_bytes > most_bytes) throw UnreadableFile("has more than " + in_megabytes(most_bytes));
  }
  bytes.resize(read_bytes);
  return bytes;
}

std::string in_megabytes(std::uintmax_t bytes) {
  constexpr std::uintmax_t megabyte = 1 << 20;
  const std::uintmax_t whole = (bytes + megabyte - 1) / megabyte;
  return std::to_string(whole) + " MB";
}

}  // namespace drape::base
