#include "solver/base/lock_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "solver/base/temporary.hpp"

namespace drape::base {

LockFile::~LockFile() {
  if (fd_ < 0) return;
  unlink(path_.c_str());
  close(fd_);
}

bool LockFile::try_lock() {
  const int fd = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (fd < 0) return true;
  const bool taken = flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (taken || !is_at(fd, path_)) {  // its last holder has removed it
    close(fd);
    return false;
  }
  fd_ = fd;
  return true;
}

}  // namespace drape::base
