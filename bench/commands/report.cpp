#include "bench/commands/report.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <span>

#include "bench/commands/argument_checks.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/output.hpp"
#include "bench/report/browser.hpp"
#include "bench/report/images.hpp"
#include "bench/report/page.hpp"
#include "results/analysis/overview.hpp"
#include "results/file/run_file.hpp"
#include "solver/base/atomic_file.hpp"
#include "solver/base/printable.hpp"

namespace drape::bench {
namespace {

struct ReportArguments {
  std::vector<std::string> files;
  std::string out;
  bool images = false;
};

void make_report(const ReportArguments& a) {
  report({a.files.begin(), a.files.end()}, a.out);
  if (!a.images) return;
  const std::filesystem::path folder = a.out;
  fmt::print("images: {} figures in {}\n", write_images(folder / "index.html", folder / "images"),
             base::printable((folder / "images").string()));
}

}  // namespace

void report(const std::vector<std::filesystem::path>& files, const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::vector<results::Recording> recordings;
  for (const auto& recorded : files) {
    names.push_back(recorded.filename().string());
    recordings.push_back(results::read_recording(recorded));
  }
  const std::vector<results::Table> overview = results::overview(recordings);
  const std::string page = report_page(names, recordings, overview);
  const std::filesystem::path file = folder / "index.html";
  base::create_folder(folder);
  base::publish(file, std::as_bytes(std::span(page)), base::Existing::replace);
  print_tables(overview, "table");
  fmt::print("\nreport: {}\n", base::printable(file.string()));
}

void add_report(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("report", "one HTML page with tables, plots and motions of recorded results");
  const auto a = std::make_shared<ReportArguments>();
  command.add_option("FILE", a->files, "HDF5 files recorded by run and study")
      ->required()
      ->type_name("...")
      ->check(not_empty());
  command.add_option("--out", a->out, "folder for index.html; an older one is replaced")
      ->required()
      ->type_name("DIR")
      ->check(output_name());
  command.add_flag(
      "--images", a->images,
      fmt::format("each figure also as SVG and PNG in DIR/images, drawn by Chromium in at most {:g} s", browsing_time));
  add_wide_option(command);
  command.callback([=] { make_report(*a); });
}

}  // namespace drape::bench
