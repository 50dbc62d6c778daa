#include "bench/runs/verbosity.hpp"

#include <fmt/format.h>

#include "solver/base/printable.hpp"

namespace drape::bench {
namespace {

Verbosity of_process = Verbosity::usual;

}  // namespace

Verbosity verbosity() { return of_process; }

void set_verbosity(Verbosity verbosity) { of_process = verbosity; }

void say_note(const std::string& remark) {
  if (of_process != Verbosity::quiet) fmt::print(stderr, "note: {}\n", base::printable(remark));
}

}  // namespace drape::bench
