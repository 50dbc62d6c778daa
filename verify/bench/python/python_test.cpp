// The Python module and what is written for it: scripts that Python runs.

#include <gtest/gtest.h>

#include "verify/support/bench_integrators.hpp"

namespace drape::verify::python_test {
namespace {

/// A script of ours, with a cache of references of its own.
ProgramResult run_script(const BenchIntegrators& program, const std::string& script, const Words& arguments) {
  Command command = program.command(Words{std::string(DRAPE_SOURCE_DIR) + "/" + script} + arguments);
  command.program = "/usr/bin/python3";
  command.environment.emplace_back("PYTHONPATH=" DRAPE_PYTHON_PATH);
  return run_program(command);
}

TEST(Python, KeepsItsChecks) {
  const ProgramResult result = run_script({}, "verify/bench/python/checks.py", {DRAPE_BENCH_INTEGRATORS});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST(Python, LeadsAnIntegratorToItsFirstCertifiedErrors) {
  const ProgramResult result = run_script({}, "bench/python/example.py", {});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("met: 1 as declared"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace drape::verify::python_test
