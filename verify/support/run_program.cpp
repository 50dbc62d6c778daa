#include "verify/support/run_program.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace drape::verify {
namespace {

void require(bool fine, const std::string& what) {
  if (!fine) throw std::system_error(errno, std::generic_category(), what);
}

}  // namespace

/// Owns an open file; not local to this source because RunningProgram has some.
struct Descriptor {
  int fd;
  Descriptor(int opened, const std::string& what) : fd(opened) { require(fd >= 0, what); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(fd); }
};

namespace {

Descriptor memory() { return {memfd_create("captured", MFD_CLOEXEC), "memfd_create"}; }

/// Appends what can be read at once; false at the end, and when the program at the other end of a terminal has closed it.
bool append(std::string& text, int fd) {
  std::array<char, 4096> buffer;
  const ssize_t n = read(fd, buffer.data(), buffer.size());
  if (n > 0) text.append(buffer.data(), static_cast<std::size_t>(n));
  return n > 0;
}

std::string content(const Descriptor& file) {
  require(lseek(file.fd, 0, SEEK_SET) == 0, "lseek");
  std::string text;
  while (append(text, file.fd)) {
  }
  return text;
}

/// The texts as execve wants them.
std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> all;
  for (std::string& text : texts) all.push_back(text.data());
  all.push_back(nullptr);
  return all;
}

struct FileActions {
  posix_spawn_file_actions_t actions;
  FileActions() { posix_spawn_file_actions_init(&actions); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  ~FileActions() { posix_spawn_file_actions_destroy(&actions); }
};

pid_t spawn(const Command& command, int out, int err) {
  std::vector<std::string> arguments{command.program}, environment = command.environment;
  arguments.insert(arguments.end(), command.arguments.begin(), command.arguments.end());
  for (char** variable = environ; *variable != nullptr; ++variable)
    environment.emplace_back(*variable);  // getenv takes the first
  FileActions files;
  posix_spawn_file_actions_addopen(&files.actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files.actions, out, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files.actions, err, STDERR_FILENO);
  posix_spawn_file_actions_addchdir_np(&files.actions, command.folder.c_str());
  pid_t pid = 0;
  errno = posix_spawn(&pid, command.program.c_str(), &files.actions, nullptr, pointers(arguments).data(),
                      pointers(environment).data());
  require(errno == 0, command.program);
  return pid;
}

/// Waits for a program's end; what it has shown is still to be taken.
ProgramResult end_of(pid_t pid) {
  int status = 0;
  rusage used{};
  require(wait4(pid, &status, 0, &used) == pid, "wait4");
  return {.exit_code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status),
          .out = {},
          .err = {},
          .peak_memory = static_cast<std::size_t>(used.ru_maxrss) * 1024};
}

}  // namespace

ProgramResult run_program(const Command& command) {
  const Descriptor out = memory(), err = memory();
  std::optional<Descriptor> elsewhere;
  if (!command.output.empty()) elsewhere.emplace(open(command.output.c_str(), O_WRONLY | O_CLOEXEC), command.output);
  ProgramResult result = end_of(spawn(command, elsewhere ? elsewhere->fd : out.fd, err.fd));
  result.out = content(out), result.err = content(err);
  return result;
}

struct RunningProgram::Process {
  Descriptor out = memory(), err = memory();
  pid_t pid = 0;  ///< 0 once it has ended
};

RunningProgram::RunningProgram(const Command& command) : process_(std::make_unique<Process>()) {
  process_->pid = spawn(command, process_->out.fd, process_->err.fd);
}

RunningProgram::~RunningProgram() {
  if (process_->pid == 0) return;
  send(SIGKILL);
  wait();
}

void RunningProgram::send(int signal) const { kill(process_->pid, signal); }

ProgramResult RunningProgram::wait() {
  ProgramResult result = end_of(std::exchange(process_->pid, 0));
  result.out = content(process_->out), result.err = content(process_->err);
  return result;
}

ProgramResult run_on_terminal(const Command& command, unsigned short columns, std::string_view until) {
  const Descriptor out = memory(), terminal(posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC), "posix_openpt");
  const winsize size{.ws_row = 24, .ws_col = columns, .ws_xpixel = 0, .ws_ypixel = 0};
  require(grantpt(terminal.fd) == 0 && unlockpt(terminal.fd) == 0 && ioctl(terminal.fd, TIOCSWINSZ, &size) == 0, "pty");
  std::optional<Descriptor> err;
  err.emplace(open(ptsname(terminal.fd), O_RDWR | O_NOCTTY | O_CLOEXEC), "ptsname");
  const pid_t pid = spawn(command, out.fd, err->fd);
  err.reset();  // or the terminal would stay open when the program ends
  std::string shown;
  while (append(shown, terminal.fd))
    if (!until.empty() && shown.find(until) != std::string::npos) kill(pid, SIGTERM);
  ProgramResult result = end_of(pid);
  result.out = content(out), result.err = shown;
  return result;
}

}  // namespace drape::verify
