#include "solver/base/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <csignal>
#include <fstream>
#include <utility>

#include "solver/base/descriptor.hpp"

namespace drape::base {
namespace {

[[noreturn]] void fail_as(int error, const std::string& program) {
  throw std::system_error(error, std::generic_category(), program);
}

std::string text_of(const Descriptor& file, const std::string& program) {
  const std::vector<std::byte> bytes = bytes_of(file, program);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// What a child is started with.
struct Setup {
  posix_spawn_file_actions_t files{};
  posix_spawnattr_t attributes{};
  Setup(const Descriptor& out, const Descriptor& err) {
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files, out.fd, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, err.fd, STDERR_FILENO);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  }
  Setup(const Setup&) = delete;
  Setup& operator=(const Setup&) = delete;
  ~Setup() {
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
  }
};

/// A program in a process group of its own, killed with all of that at the end of the scope unless it has ended.
class Group {
 public:
  Group(std::vector<std::string>& words, const Setup& setup) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const int error = posix_spawnp(&leader_, arguments[0], &setup.files, &setup.attributes, arguments.data(), environ);
    if (error != 0) fail_as(error, words[0]);
  }
  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;
  ~Group() {
    if (!ended_) end();
  }

  /// The exit code of its leader.
  int wait(double seconds, const std::string& program) {
    const Descriptor ended(static_cast<int>(syscall(SYS_pidfd_open, leader_, 0)));  // glibc 2.36 declares no C function
    pollfd event{.fd = ended.fd, .events = POLLIN, .revents = 0};
    const int events = poll(&event, 1, static_cast<int>(1000 * seconds));
    if (events < 0) fail_as(errno, program);
    if (events == 0) fail_as(ETIMEDOUT, fmt::format("{} has not ended in {:g} s", program, seconds));
    const int status = end();
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  }

 private:
  /// Kills the rest of the group before its number is released.
  int end() {
    kill(-leader_, SIGKILL);
    ended_ = true;
    int status = 0;
    waitpid(leader_, &status, 0);
    return status;
  }

  pid_t leader_ = 0;
  bool ended_ = false;
};

}  // namespace

std::string ChildSaid::failure() const {
  if (exit_code == 0) return "";
  if (exit_code > 128) return fmt::format("ended by signal {}", exit_code - 128);
  const std::size_t end = err.find_last_not_of('\n') + 1, begin = end > 0 ? err.rfind('\n', end - 1) + 1 : 0;
  return err.substr(begin, end - begin);
}

ChildSaid run_child(std::vector<std::string> words, double seconds) {
  const Descriptor out(memfd_create("out", MFD_CLOEXEC)), err(memfd_create("err", MFD_CLOEXEC));
  if (out.fd < 0 || err.fd < 0) fail_as(errno, words[0]);
  const Setup setup(out, err);
  Group group(words, setup);
  const int code = group.wait(seconds, words[0]);
  return {code, text_of(out, words[0]), text_of(err, words[0])};
}

double peak_memory() {
  std::ifstream status("/proc/self/status");  // getrusage() counts the program that started this one as well
  for (std::string word; status >> word;)
    if (double kilobytes = 0; word == "VmHWM:" && status >> kilobytes) return kilobytes / 1024;
  return 0;
}

}  // namespace drape::base
