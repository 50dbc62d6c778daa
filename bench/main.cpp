#include <malloc.h>

#include "bench/commands/command_line.hpp"

int main(int argc, char** argv) {
  // Freed memory is kept, so that runs do not wait for the kernel to clear the pages of the run before them again.
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
  return drape::bench::run_command_line(argc, argv);
}
