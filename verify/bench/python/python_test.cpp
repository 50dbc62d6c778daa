// The Python module and what is written for it: scripts that Python runs.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "verify/support/bench_integrators.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::python_test {
namespace {

/// A script of ours, with a cache of references of its own.
ProgramResult run_script(const BenchIntegrators& program, const std::string& script, const Words& arguments,
                         const std::string& interpreter = "/usr/bin/python3") {
  Command command = program.command(Words{std::string(DRAPE_SOURCE_DIR) + "/" + script} + arguments);
  command.program = interpreter;
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

/// What the seconds are, the script says.
TEST(Python, LeadsFromNothingToACertifiedTable) {
  DRAPE_SLOW();
  const ProgramResult result = run_script({}, "bench/python/first_table", {}, "/bin/bash");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, testing::StartsWith("Errors against the certified reference\n"));
  EXPECT_THAT(result.out, testing::ContainsRegex(" heun +0.00025 +success +[0-9.e-]+ +[0-9.e-]+ "));
  EXPECT_THAT(result.out, testing::ContainsRegex("\n +heun +[0-9.]+ [^\n]* met: 2 as declared\n"));
  EXPECT_THAT(result.out, testing::ContainsRegex("\n7 lines of Python, [0-9]+ s to their table\n$"));
}

}  // namespace
}  // namespace drape::verify::python_test
