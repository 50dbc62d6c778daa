#include <fmt/format.h>

#include <memory>
#include <string>

#include "bench/commands/argument_checks.hpp"
#include "bench/commands/commands.hpp"
#include "model/pattern/sewn_pattern.hpp"

namespace drape::bench {
namespace {

constexpr double least_spacing = 1e-3, largest_spacing = 1;  // [m]

}  // namespace

void add_pattern(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("pattern", "a sewing pattern as a scene");
  const auto file = std::make_shared<std::string>();
  const auto spacing = std::make_shared<double>(model::usual_spacing);
  command
      .add_option("FILE", *file,
                  "of GarmentCode (.json), of curves in mm (.toml), or a mesh of a garment or of a flat cloth (.obj, .ply)")
      ->required()
      ->type_name("");
  command.add_option("--spacing", *spacing, "length of cells [m]")
      ->check(between(least_spacing, largest_spacing))
      ->type_name("L")
      ->capture_default_str();
  command.callback([=] { fmt::print("{}", model::to_toml(model::sew(model::read_pattern(*file), *spacing))); });
}

}  // namespace drape::bench
