#include "bench/report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "bench/report/embedded.hpp"
#include "bench/report/page_data.hpp"

namespace drape::bench {
namespace {

/// JSON inside a <script>: no text in it can end the element.
std::string script_data(const nlohmann::ordered_json& data) {
  std::string safe;
  for (const char c : data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace))
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  return safe;
}

bool has_trajectory(const nlohmann::ordered_json& file) {
  return std::ranges::any_of(file["runs"], [](const auto& run) { return run.contains("trajectory"); });
}

void add_script(std::string& page, std::string_view script) {
  page.append("<script>\n").append(script).append("\n</script>\n");
}

}  // namespace

std::string report_page(std::span<const std::string> names, std::span<const results::Recording> recordings,
                        std::span<const results::Table> overview) {
  nlohmann::ordered_json data{{"files", nlohmann::ordered_json::array()}, {"overview", nlohmann::ordered_json::array()}};
  for (std::size_t k = 0; k < names.size(); ++k) data["files"].push_back(page_data(names[k], recordings[k]));
  for (const results::Table& table : overview) data["overview"].push_back(page_table(table));

  std::string page(embedded::head_html);
  page.append("<style>\n").append(embedded::style_css).append("</style>\n").append(embedded::body_html);
  page.append(fmt::format("<script type=\"application/json\" id=\"data\">{}</script>\n", script_data(data)));
  add_script(page, embedded::plotly_js);
  if (std::ranges::any_of(data["files"], has_trajectory)) {
    add_script(page, embedded::three_js);
    add_script(page, embedded::orbit_controls_js);
  }
  add_script(page, embedded::report_js);
  return page + "</html>\n";
}

}  // namespace drape::bench
