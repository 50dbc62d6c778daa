#include "model/keys/data.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <sstream>

namespace drape::model {
namespace {

struct TomlWriter {
  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(bool flag) const { return flag ? "true" : "false"; }
  std::string operator()(double number) const { return fmt::format("{}", number); }
  std::string operator()(const std::string& text) const {
    std::ostringstream out;
    const toml::value<std::string> value{text};
    out << toml::toml_formatter{value, toml::format_flags::allow_unicode_strings};  // literal, multi-line ones lose characters
    return out.str();
  }
  std::string operator()(const List& list) const {
    std::vector<std::string> values;
    for (const Data& value : list) values.push_back(to_toml(value));
    return fmt::format("[{}]", fmt::join(values, ", "));
  }
  std::string operator()(const Entries& table) const {
    std::vector<std::string> entries;
    for (const auto& [key, value] : table) entries.push_back(fmt::format("{} = {}", key, to_toml(value)));
    return fmt::format("{{ {} }}", fmt::join(entries, ", "));
  }
};

}  // namespace

Data to_data(const WeftWarp& m) { return List{m.weft, m.warp}; }

Data to_data(const Eigen::Vector3d& a) { return List{a[0], a[1], a[2]}; }

std::string to_toml(const Data& data) { return std::visit(TomlWriter(), data); }

}  // namespace drape::model
