#include "bench/commands/argument_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>

#include "bench/runs/shard.hpp"
#include "solver/base/printable.hpp"
#include "solver/base/registry.hpp"

namespace drape::bench {
namespace {

CLI::Validator expect(const std::string& what, const std::function<bool(const std::string&)>& right) {
  const auto complaint = [=](const std::string& text) {
    return right(text) ? "" : fmt::format("expected {}, not '{}'", what, base::quoted(text));
  };
  return {complaint, ""};
}

template <class Number>
CLI::Validator expect_number(const std::string& what, const std::function<bool(Number)>& right) {
  return expect(what, [=](const std::string& text) {
    Number value{};
    return CLI::detail::lexical_cast(text, value) && right(value);
  });
}

std::string unknown_argument(const CLI::App& command, const std::string& argument) {
  std::vector<std::string> known;
  for (const CLI::App* subcommand : command.get_subcommands({})) known.push_back(subcommand->get_name());
  for (const CLI::Option* option : command.get_options()) known.push_back(option->get_name());
  const std::vector<std::string_view> names(known.begin(), known.end());
  return base::unknown_name("argument", argument, names);
}

}  // namespace

CLI::Validator positive() {
  return expect_number<double>("a finite number above 0", [](double value) { return value > 0 && std::isfinite(value); });
}

CLI::Validator between(double least, double most) {
  return expect_number<double>(fmt::format("a number from {} to {}", least, most),
                               [=](double value) { return least <= value && value <= most; });
}

CLI::Validator between(int least, int most) {
  return expect_number<int>(fmt::format("a whole number from {} to {}", least, most),
                            [=](int value) { return least <= value && value <= most; });
}

CLI::Validator one_of(const std::string& kind, const std::vector<std::string>& names) {
  const auto complaint = [=](const std::string& text) {
    const std::vector<std::string_view> all(names.begin(), names.end());
    return std::ranges::find(names, text) != names.end() ? "" : base::unknown_name(kind, text, all);
  };
  return {complaint, ""};
}

CLI::Validator not_empty() {
  return expect("a name", [](const std::string& text) { return !text.empty(); });
}

CLI::Validator output_name() {
  return expect("a name, which may begin with '-' as in ./-x only",
                [](const std::string& text) { return !text.empty() && text[0] != '-'; });
}

CLI::Validator every_seconds() {
  return expect("every=SECONDS with a finite number above 0", [](const std::string& text) {
    const double seconds = seconds_every(text);
    return seconds > 0 && std::isfinite(seconds);
  });
}

double seconds_every(const std::string& text) {
  const std::string key = "every=";
  double seconds = 0;
  return text.starts_with(key) && CLI::detail::lexical_cast(text.substr(key.size()), seconds) ? seconds : 0;
}

CLI::Validator shard_name() {
  return expect("i/n with 1 <= i <= n <= 10000", [](const std::string& text) { return share_named(text).has_value(); });
}

std::string explanation(const CLI::App& app, const CLI::ParseError& error) {
  const auto is = [&](CLI::ExitCodes code) { return error.get_exit_code() == static_cast<int>(code); };
  if (is(CLI::ExitCodes::ValidationError)) return error.what();
  const CLI::App& command = app.get_subcommands().empty() ? app : *app.get_subcommands().front();
  std::vector<std::string> unknown = app.remaining(/*recurse=*/true);
  std::erase(unknown, "--");
  if (is(CLI::ExitCodes::ExtrasError) || (is(CLI::ExitCodes::RequiredError) && !unknown.empty()))
    return unknown_argument(command, unknown.empty() ? error.what() : unknown.front());
  return fmt::format("{}; see {}{} --help", error.what(), app.get_name(), &command == &app ? "" : " " + command.get_name());
}

}  // namespace drape::bench
