#include "bench/report/browser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>
#include <utility>

#include "solver/base/process.hpp"
#include "solver/base/temporary.hpp"

namespace drape::bench {
namespace {

std::string read_page(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Waits for the page, runs the script and leaves nothing in the page but what it saw. Chromium prints a page once it is
/// loaded: a document in it that is not closed holds that back.
std::string driver(const std::string& script) {
  return R"(<script>
const hold = document.body.appendChild(document.createElement("iframe"));
hold.contentDocument.open();
const see = (text) => {
  const shown = document.createElement("pre");
  shown.id = "seen";
  shown.textContent = text;
  hold.contentDocument.close();
  document.documentElement.replaceChildren(shown);
};
setTimeout(() => see("nothing in time"), )" +
         fmt::format("{}", 1000 * (browsing_time - 10)) + R"();
(async () => {
  while (!document.documentElement.hasAttribute("data-drawn")) await new Promise((resolve) => setTimeout(resolve, 20));
  )" + script +
         R"(
})().catch((error) => { console.error(error.stack); see(""); });
</script>)";
}

/// Chromium with a profile of its own, without network and with a graphics card in software. Root may start it without its
/// sandbox only; the page is our own file.
std::vector<std::string> chromium(const base::TemporaryFolder& folder, const std::filesystem::path& page, int width) {
  return {"chromium",
          "--headless",
          "--no-sandbox",
          "--disable-gpu",
          "--use-angle=swiftshader",
          "--enable-unsafe-swiftshader",
          "--disable-quic",
          "--no-first-run",
          "--disable-background-networking",
          "--disable-component-update",
          "--disable-sync",
          "--hide-scrollbars",
          "--enable-logging=stderr",
          "--virtual-time-budget=10000",
          "--user-data-dir=" + (folder / "profile").string(),
          fmt::format("--window-size={},900", width),
          "--dump-dom",
          "file://" + page.string()};
}

/// Text of HTML with its escapes undone.
std::string unescaped(std::string_view html) {
  constexpr std::array<std::pair<std::string_view, char>, 4> escapes{
      {{"&lt;", '<'}, {"&gt;", '>'}, {"&nbsp;", ' '}, {"&amp;", '&'}}};
  std::string text;
  while (!html.empty()) {
    const auto* const escape = std::ranges::find_if(escapes, [&](const auto& any) { return html.starts_with(any.first); });
    text += escape == escapes.end() ? html.front() : escape->second;
    html.remove_prefix(escape == escapes.end() ? 1 : escape->first.size());
  }
  return text;
}

/// What is between the tags of see()'s element.
std::string seen_in(std::string_view dom) {
  constexpr std::string_view open = "<pre id=\"seen\">";
  const auto start = dom.find(open), end = dom.find("</pre>", start);
  if (start == std::string::npos) return {};
  return unescaped(dom.substr(start + open.size(), end - start - open.size()));
}

std::vector<std::string> console_of(const std::string& log) {
  std::vector<std::string> messages;
  std::istringstream in(log);
  for (std::string line; std::getline(in, line);)
    if (line.find("CONSOLE:") != std::string::npos && line.find("GL Driver Message") == std::string::npos)
      messages.push_back(line);
  return messages;
}

}  // namespace

Browsed browse(const std::filesystem::path& page, const std::string& script, int width) {
  const base::TemporaryFolder folder;
  const std::filesystem::path driven = folder / "driven.html";
  std::ofstream(driven) << read_page(page) << driver(script);
  const base::ChildSaid said = base::run_child(chromium(folder, driven, width), browsing_time);
  return {seen_in(said.out), console_of(said.err)};
}

}  // namespace drape::bench
