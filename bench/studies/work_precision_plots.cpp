#include <fmt/format.h>

#include <algorithm>

#include "bench/plot.hpp"
#include "bench/studies.hpp"
#include "results/work_precision.hpp"

namespace drape::bench {
namespace {

using results::Cell;
using results::Table;

const std::vector<Cell>& column(const Table& table, const char* name) {
  return std::ranges::find(table.columns, name, &results::Column::name)->cells;
}

std::string text(const Cell& cell) {
  const auto* value = std::get_if<std::string>(&cell);
  return value ? *value : "";
}

/// A row of a table of trials that succeeded.
struct Row {
  std::string code;
  bool by_default;
  results::Measured measured;
};

std::vector<Row> rows(const Table& table) {
  std::vector<Row> all;
  for (std::size_t k = 0; k < column(table, "code").size(); ++k)
    if (const auto* error = std::get_if<double>(&column(table, "error")[k]); error && *error > 0)
      all.push_back({text(column(table, "code")[k]),
                     !text(column(table, "method")[k]).empty(),
                     {*error, {std::get<double>(column(table, "time")[k])}}});
  return all;
}

template <class Belongs>
Series front(const std::string& name, const std::vector<Row>& rows, const Belongs& belongs) {
  std::vector<results::Measured> measured;
  for (const Row& row : rows)
    if (belongs(row)) measured.push_back(row.measured);
  std::vector<std::size_t> order = results::near_front(measured, 1);
  std::ranges::sort(order, {}, [&](std::size_t k) { return measured[k].error; });
  Series series{name, {}, {}};
  for (const std::size_t k : order) {
    series.x.push_back(measured[k].error);
    series.y.push_back(measured[k].times.front());
  }
  return series;
}

bool is_ours(const Row& row) { return row.code == "drape" || row.code == "explicit" || row.code == "thesis"; }

Plot plot(const Table& table) {
  const std::vector<Row> all = rows(table);
  Plot plot{table.description, "", "solver time [ms]", {}};
  Series dots{"all of ours", {}, {}, false};
  for (const Row& row : all)
    if (is_ours(row)) {
      dots.x.push_back(row.measured.error);
      dots.y.push_back(row.measured.times.front());
    }
  plot.series = {std::move(dots), front("our best", all, is_ours),
                 front("automatic", all, [](const Row& row) { return row.by_default; })};
  std::vector<std::string> codes;
  for (const Row& row : all)
    if (row.code != "drape" && std::ranges::find(codes, row.code) == codes.end()) codes.push_back(row.code);
  for (const std::string& code : codes)
    plot.series.push_back(front(code, all, [&](const Row& row) { return row.code == code; }));
  plot.uncertain_below = std::get<double>(column(table, "uncertainty").front());
  plot.x_title =
      fmt::format("error: largest distance at three times, over the size of the scene; reference uncertain by {:.1g}",
                  plot.uncertain_below);
  return plot;
}

}  // namespace

void plot_work_precision(std::span<const Table> tables, const std::filesystem::path& out) {
  const std::string prefix = "trials: ";
  for (const Table& table : tables) {
    if (!table.name.starts_with(prefix)) continue;
    std::string name = table.name.substr(prefix.size());
    std::ranges::replace(name, ' ', '-');
    std::ranges::replace(name, '=', '-');
    const std::string remark = draw(plot(table), std::filesystem::path(out).replace_extension("." + name));
    if (!remark.empty()) fmt::print(stderr, "note: {}\n", remark);
  }
}

}  // namespace drape::bench
