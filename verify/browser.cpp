#include "verify/browser.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "verify/bench_integrators.hpp"

namespace drape::verify {
namespace {

constexpr const char* chromium = "/usr/bin/chromium";

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
setTimeout(() => see("nothing within a minute"), 60000);
(async () => {
  while (!document.documentElement.hasAttribute("data-drawn")) await new Promise((resolve) => setTimeout(resolve, 20));
  )" + script +
         R"(
})().catch((error) => { console.error(error.stack); see(""); });
</script>)";
}

/// Chromium with a profile of its own, without network and with a graphics card in software.
ProgramResult run_chromium(const TemporaryFolder& folder, const Words& arguments) {
  return run_program(
      {.program = chromium,
       .arguments = Words{"--headless", "--no-sandbox", "--disable-gpu", "--use-angle=swiftshader",
                          "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run", "--disable-background-networking",
                          "--disable-component-update", "--disable-sync", "--hide-scrollbars", "--enable-logging=stderr",
                          "--virtual-time-budget=10000", "--user-data-dir=" + (folder / "profile").string()} +
                    arguments,
       .folder = folder.path(),
       .environment = {},
       .output = {}});
}

/// What is between the tags of see()'s element, with its escapes undone.
std::string seen_in(const std::string& dom) {
  const std::string open = "<pre id=\"seen\">";
  const auto start = dom.find(open), end = dom.find("</pre>", start);
  if (start == std::string::npos) return {};
  std::string text = dom.substr(start + open.size(), end - start - open.size());
  for (const auto& [escape, character] : {std::pair{"&lt;", "<"}, {"&gt;", ">"}, {"&nbsp;", " "}, {"&amp;", "&"}})
    for (auto at = text.find(escape); at != std::string::npos; at = text.find(escape, at + 1))
      text.replace(at, std::string(escape).size(), character);
  return text;
}

Words console_of(const std::string& log) {
  Words messages;
  for (const std::string& line : lines(log))
    if (line.find("CONSOLE:") != std::string::npos && line.find("GL Driver Message") == std::string::npos)
      messages.push_back(line);
  return messages;
}

}  // namespace

Browsed browse(const std::filesystem::path& page, const std::string& script, int width) {
  const TemporaryFolder folder;
  std::ofstream(folder / "driven.html") << read_page(page) << driver(script);
  const ProgramResult result = run_chromium(
      folder, {fmt::format("--window-size={},900", width), "--dump-dom", "file://" + (folder / "driven.html").string()});
  return {seen_in(result.out), console_of(result.err)};
}

}  // namespace drape::verify
