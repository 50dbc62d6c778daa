#include "bench/runs/machine_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <thread>

#include "bench/runs/interruption.hpp"
#include "solver/base/temporary.hpp"

namespace drape::bench {
namespace {

std::filesystem::path machine_lock_path() { return base::system_folder() / fmt::format("drape-{}.lock", getuid()); }

int open_machine_lock() {
  const std::filesystem::path path = machine_lock_path();
  const int fd = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (fd < 0) base::fail(path, "the lock of the shards on this machine cannot be opened");
  return fd;
}

/// Bytes of the file. Who waits for the room holds the gate, so that those who come later do not overtake.
enum class Part : off_t { gate, room };

/// Locks or unlocks a part; waits by asking again, so that an interruption ends it.
void set_lock(const base::Descriptor& file, Part part, short type) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = static_cast<off_t>(part);
  lock.l_len = 1;
  while (fcntl(file.fd, F_OFD_SETLK, &lock) != 0) {
    if (errno != EAGAIN && errno != EACCES) base::fail(machine_lock_path(), "cannot be locked");
    check_interruption();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

void enter(const base::Descriptor& file, short type) {
  set_lock(file, Part::room, F_UNLCK);
  set_lock(file, Part::gate, F_WRLCK);
  set_lock(file, Part::room, type);
  set_lock(file, Part::gate, F_UNLCK);
}

}  // namespace

MachineLock::MachineLock() : file_(open_machine_lock()) { beside_others(); }

void MachineLock::alone() { enter(file_, F_WRLCK); }

void MachineLock::beside_others() { enter(file_, F_RDLCK); }

}  // namespace drape::bench
