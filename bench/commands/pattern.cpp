#include <fmt/format.h>

#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "bench/commands/argument_checks.hpp"
#include "bench/commands/commands.hpp"
#include "model/pattern/sewn_pattern.hpp"
#include "model/scene_file/scene_file.hpp"

namespace drape::bench {
namespace {

constexpr double usual_spacing = 0.03, least_spacing = 1e-3, largest_spacing = 1;  // [m]

/// The keys of a scene that differ from those of another as TOML; lists as tables, behind them.
void print_changes(const model::Scene& scene, const model::Scene& from) {
  std::map<std::string, std::string> usual, own;
  for (const model::KeyValue& row : model::key_values(from)) usual[row.key] = to_toml(row.value);
  const std::vector<model::KeyValue> rows = model::key_values(scene);
  for (const model::KeyValue& row : rows) {
    const std::string value = own[row.key] = to_toml(row.value);
    if (!std::holds_alternative<model::Entries>(row.value) && usual[row.key] != value) fmt::print("{} = {}\n", row.key, value);
  }
  for (const model::KeyValue& row : rows) {
    const auto* table = std::get_if<model::Entries>(&row.value);
    if (table == nullptr) continue;
    fmt::print("\n[[{}]]\n", row.key);
    for (const auto& [key, data] : *table) {
      const std::string value = to_toml(data);
      const bool is_usual = own.contains(key) ? own[key] == value : value.empty() || value == "[]";
      if (!is_usual) fmt::print("{} = {}\n", key, value);
    }
  }
}

void convert_pattern(const std::string& file, double spacing) {
  const model::SewnPattern sewn = model::sew(model::read_pattern(file), spacing);
  if (!sewn.remarks.empty()) fmt::print("# Seams:\n");
  for (const std::string& remark : sewn.remarks) fmt::print("#   {}\n", remark);
  fmt::print("\n");
  print_changes(sewn.scene, {});
}

}  // namespace

void add_pattern(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("pattern", "a sewing pattern as a scene");
  const auto file = std::make_shared<std::string>();
  const auto spacing = std::make_shared<double>(usual_spacing);
  command.add_option("FILE", *file, "of GarmentCode (.json), of curves in mm (.toml), or a garment mesh (.obj)")
      ->required()
      ->type_name("");
  command.add_option("--spacing", *spacing, "length of cells [m]")
      ->check(between(least_spacing, largest_spacing))
      ->type_name("L")
      ->capture_default_str();
  command.callback([=] { convert_pattern(*file, *spacing); });
}

}  // namespace drape::bench
