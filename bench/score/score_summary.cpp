#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/score/measures.hpp"
#include "bench/score/score.hpp"
#include "results/run_record.hpp"

namespace drape::bench {
namespace {

using results::Table;

const Table& named(const std::vector<Table>& tables, std::string_view name) {
  return *std::ranges::find(tables, name, &Table::name);
}

double number(const Table& table, std::string_view column, std::size_t row = 0) {
  return number_in(find_column(table, column), row);
}

std::string text(const Table& table, std::string_view column, std::size_t row = 0) {
  return text_in(find_column(table, column), row);
}

std::string error_line(const Table& s) {
  return fmt::format(
      "error        {:.3g} of the size (rms, at {:g} s), {:.3g} at the end; largest of a particle {:.3g}; reference {:.1e}\n",
      number(s, "error"), number(s, "error_time"), number(s, "end_error"), number(s, "maximum"), number(s, "reference_error"));
}

std::string lag_line(const Table& s) {
  const double lag = number(s, "lag");
  if (std::isnan(lag)) return "lag          nothing moves\n";
  return fmt::format(
      "lag          {:.3g} ms {}{} (± {:.1e}); the error falls from {:.3g} to {:.3g} (rms over all frames) without it\n",
      std::abs(1e3 * lag), lag < 0 ? "ahead" : "late", std::abs(lag) < 0.999 * longest_lag * number(s, "end") ? "" : " or more",
      1e3 * number(s, "lag_uncertainty"), number(s, "mean_error"), number(s, "left"));
}

std::string damping_line(const Table& s) {
  const double rate = number(s, "damping");
  if (std::isnan(rate)) return "";
  return fmt::format("damping      the kinetic energy falls by {:.3g} 1/s too {} (± {:.1e})\n", std::abs(rate),
                     rate < 0 ? "little" : "much", number(s, "damping_uncertainty"));
}

std::string energy_line(const Table& s) {
  return fmt::format("energy       {:.4g} J at the end, the reference {:.4g} J (± {:.1e}); velocities from {}\n",
                     number(s, "energy"), number(s, "reference_energy"), number(s, "energy_uncertainty"),
                     text(s, "velocities"));
}

std::string penetration_line(const Table& s) {
  const double depth = number(s, "penetration");
  if (std::isnan(depth)) return "";
  return fmt::format("penetration  {:.3g} mm at {:g} s; the reference {:.3g} mm\n", 1e3 * depth, number(s, "penetration_time"),
                     1e3 * number(s, "reference_penetration"));
}

/// `prefix`: of the columns that answer the question.
std::string best_line(const Table& ours, const std::string& prefix, const char* question) {
  for (std::size_t k = 0; k < rows(ours); ++k)
    if (!text(ours, prefix + "best", k).empty())
      return fmt::format("ours         {}: {}, {:.2g}: error {:.3g} in {:.3g} ms\n", question, text(ours, "method", k),
                         number(ours, prefix + "value", k), number(ours, prefix + "error", k),
                         number(ours, prefix + "time", k));
  return "";
}

std::string best_lines(const Table& ours) {
  const std::string as_right = best_line(ours, "", "quickest at most as wrong");
  return (as_right.empty() ? "ours         none of those tried is as right\n" : as_right) +
         best_line(ours, "cost_", "least wrong that takes no longer");
}

std::string growth_line(const Table& s) {
  const double growth = number(s, "growth");
  if (!(growth > results::comparable_growth)) return "";
  return fmt::format("note         small perturbations of the start grow by {:.2g}: positions say little about a method\n",
                     growth);
}

}  // namespace

std::string score_summary(const std::vector<Table>& tables) {
  const Table &s = named(tables, "score-summary"), &ours = named(tables, "score-ours");
  return fmt::format("{} on {}: {} frames to {:g} s\n", text(s, "file"), text(s, "scene"), number(s, "frames"),
                     number(s, "end")) +
         error_line(s) + lag_line(s) + damping_line(s) + energy_line(s) + penetration_line(s) + growth_line(s) +
         best_lines(ours);
}

}  // namespace drape::bench
