#include "verify/support/limited_program.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <span>
#include <string>

namespace drape::verify {
namespace {

#ifdef DRAPE_SANITIZE
constexpr std::size_t most_memory = std::size_t{4} << 30;  // sanitizers keep what is freed
#else
constexpr std::size_t most_memory = std::size_t{300} << 20;
#endif

}  // namespace

ProgramResult run_limited(const BenchIntegrators& program, const Words& words) {
  Command command = program.command(words);
  command.arguments = Words{"-s", "KILL", "60", command.program} + words;
  command.program = "/usr/bin/timeout";
  ProgramResult result = run_program(command);
  EXPECT_THAT(result.exit_code, testing::AnyOf(0, 1, 2)) << joined(words, " ") << "\n" << result.err;
  EXPECT_THAT(lines(result.err), testing::SizeIs(testing::Le(1u))) << joined(words, " ") << "\n" << result.err;
  EXPECT_LT(result.peak_memory, most_memory) << joined(words, " ");
  return result;
}

std::vector<std::byte> content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

}  // namespace drape::verify
