#include "solver/base/sandbox.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <fstream>
#include <new>
#include <span>
#include <string>
#include <system_error>

#include "solver/base/descriptor.hpp"

namespace drape::base {
namespace {

/// How a copy ends, as exit codes that nothing else uses.
enum Ending : int { done = 70, failed = 71, out_of_memory = 72 };

constexpr const char* own_process = "process of its own";

[[noreturn]] void fail_as(int error) { throw std::system_error(error, std::generic_category(), own_process); }

/// At most `value`, or what the system allows.
void limit(int resource, rlim_t value) {
  rlimit now{};
  if (getrlimit(static_cast<__rlimit_resource>(resource), &now) != 0) fail_as(errno);
  const rlimit wanted{std::min(value, now.rlim_max), now.rlim_max};
  if (setrlimit(static_cast<__rlimit_resource>(resource), &wanted) != 0) fail_as(errno);
}

void put(const Descriptor& out, std::span<const std::byte> bytes) { write_all(own_process, out.fd, bytes); }

Ending compute_in_copy(const std::function<std::vector<std::byte>()>& compute, const SandboxLimits& limits,
                       const Descriptor& out, const Descriptor& silence) {
  try {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const auto own = static_cast<unsigned>(out.fd);
    dup2(silence.fd, STDERR_FILENO);             // what the C library says of a heap that it finds corrupted
    close_range(STDERR_FILENO + 1, own - 1, 0);  // a killed program's locks must not live on in its copy
    close_range(own + 1, ~0U, 0);
    std::signal(SIGXCPU, SIG_DFL);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, static_cast<rlim_t>(std::ceil(limits.cpu_seconds)));
    limit(RLIMIT_DATA, data_held() + limits.bytes);
    put(out, compute());
    return done;
  } catch (const std::bad_alloc&) {
    return out_of_memory;
  } catch (const std::exception& error) {
    put(out, std::as_bytes(std::span(std::string_view(error.what()))));
    return failed;
  }
}

int status_of(pid_t copy) {
  int status = 0;
  while (waitpid(copy, &status, 0) < 0)
    if (errno != EINTR) fail_as(errno);
  return status;
}

[[noreturn]] void say_why(int status, const std::vector<std::byte>& said, const SandboxLimits& limits) {
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  if (code == failed) throw SandboxError(std::string(reinterpret_cast<const char*>(said.data()), said.size()));
  if (code == out_of_memory) throw SandboxEnded(fmt::format("takes more than {} MiB", limits.bytes >> 20));
  if (code != 0) throw SandboxEnded(fmt::format("ends with exit code {}", code));
  if (WTERMSIG(status) == SIGXCPU) throw SandboxEnded(fmt::format("takes longer than {:g} s", limits.cpu_seconds));
  throw SandboxEnded(fmt::format("ends by signal {}", WTERMSIG(status)));
}

}  // namespace

std::size_t data_held() {
  std::ifstream statm("/proc/self/statm");  // in pages as its sixth number, with the stack
  std::size_t pages = 0;
  for (int k = 0; k < 6; ++k) statm >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

std::vector<std::byte> in_sandbox(const std::function<std::vector<std::byte>()>& compute, const SandboxLimits& limits) {
  const Descriptor out(memfd_create("sandbox", MFD_CLOEXEC));
  const Descriptor silence(open("/dev/null", O_WRONLY | O_CLOEXEC));
  if (out.fd < 0 || silence.fd < 0) fail_as(errno);
  const pid_t copy = fork();
  if (copy < 0) fail_as(errno);
  if (copy == 0) _exit(compute_in_copy(compute, limits, out, silence));
  const int status = status_of(copy);
  std::vector<std::byte> said = bytes_of(out, own_process);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != done) say_why(status, said, limits);
  return said;
}

}  // namespace drape::base
