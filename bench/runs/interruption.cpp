#include "bench/runs/interruption.hpp"

#include <atomic>
#include <csignal>

namespace drape::bench {
namespace {

std::atomic<int> noted_signal = 0;  // threads read it
static_assert(std::atomic<int>::is_always_lock_free, "a handler may write it");

}  // namespace

void note_interruptions() {
  struct sigaction action {};
  action.sa_handler = [](int signal) { noted_signal = signal; };
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
}

void forget_interruptions() { noted_signal = 0; }

void check_interruption() {
  if (const int signal = noted_signal; signal != 0) throw Interrupted{signal};
}

}  // namespace drape::bench
