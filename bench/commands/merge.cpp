#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/commands/argument_checks.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/help.hpp"
#include "bench/commands/shell_words.hpp"
#include "solver/base/atomic_file.hpp"

namespace drape::bench {
namespace {

struct MergeArguments {
  std::string out;
  std::vector<std::filesystem::path> shards;
};

/// The command of a shard, from its subcommand on, as it would be for all shards.
std::vector<std::string> whole_command(const MergeArguments& a) {
  const std::vector<std::string> words = shell_words(value_of(origin_of(a.shards.front()), "command_line"));
  const auto is_subcommand = [](const std::string& word) { return word == "run" || word == "study"; };
  std::vector<std::string> whole;
  for (auto word = std::ranges::find_if(words, is_subcommand); word != words.end(); ++word) {
    const bool replaced = *word == "--shard" || *word == "--out";
    if (replaced && word + 1 != words.end()) ++word;  // with its value
    if (!replaced && !word->starts_with("--shard=") && !word->starts_with("--out=") && *word != "--resume")
      whole.push_back(*word);
  }
  if (whole.empty()) throw base::FileError(fmt::format("{}: is not the journal of a shard", a.shards.front().string()));
  whole.insert(whole.end(), {"--out", a.out});
  return whole;
}

/// Does the command again, with all results taken from the shards.
void merge(const MergeArguments& a) {
  std::vector<std::string> command = whole_command(a);
  SweepOptions defaults;
  defaults.merged = a.shards;
  defaults.start = results::Start::resumed;  // after a merge that was killed
  defaults.command_line = "bench_integrators";
  for (const std::string& word : command) defaults.command_line += " " + shell_word(word);
  CLI::App app;
  add_run(app, defaults);
  add_study(app, defaults);
  std::ranges::reverse(command);  // as CLI11 takes them
  app.parse(std::move(command));
}

}  // namespace

void add_merge(CLI::App& app) {
  CLI::App& command =
      *app.add_subcommand("merge", "one file of all shards of a sweep, which run and study compute with --shard");
  const auto a = std::make_shared<MergeArguments>();
  command.add_option("OUT", a->out, "HDF5 file to record in")->required()->type_name("")->check(output_name());
  command.add_option("SHARD", a->shards, "journals of the shards, OUT.shard-i-of-n.journal")
      ->required()
      ->type_name("...")
      ->check(not_empty());
  command.footer(
      help_text("Run it in the folder in which the shards ran, by the same program. Exit code: 1 if results are missing."));
  command.callback([=] { merge(*a); });
}

}  // namespace drape::bench
