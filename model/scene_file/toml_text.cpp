#include "model/scene_file/toml_text.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <sstream>

namespace drape::model {

std::string in_quotes(std::string_view text) {
  std::ostringstream out;
  const toml::value<std::string> value{std::string(text)};
  out << toml::toml_formatter{value, toml::format_flags::allow_unicode_strings};  // literal and multi-line ones lose characters
  return out.str();
}

std::string written(const WeftWarp& m) { return fmt::format("[{}, {}]", m.weft, m.warp); }

std::string written(const Eigen::Vector3d& a) { return fmt::format("[{}, {}, {}]", a[0], a[1], a[2]); }

}  // namespace drape::model
