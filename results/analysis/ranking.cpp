#include "results/analysis/ranking.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "results/columns.hpp"

namespace drape::results {
namespace {

constexpr int digits = 7;        ///< of the smallest error
constexpr double telling = 0.3;  ///< part of an error that the reference may be uncertain by

/// The least time [ms] of those that reach an error in a scene; infinite if none does.
struct Quickest {
  double ours = INFINITY;
  std::map<std::string, double> methods;

  void see(const std::string& method, double time) {
    ours = std::min(ours, time);
    if (method.empty()) return;
    const auto known = methods.try_emplace(method, INFINITY).first;
    known->second = std::min(known->second, time);
  }
};

bool is_ours(const std::string& code) { return code == "drape" || code == "explicit" || code == "thesis"; }

Quickest quickest(const Table& trials, double error) {
  const auto column = [&](const char* name) { return find_column(trials, name); };
  Quickest result;
  for (std::size_t row = 0; row < rows(trials); ++row) {
    const bool timed = number_in(column("repetitions"), row) > 1;
    const bool known = number_in(column("uncertainty"), row) <= telling * error;
    if (is_ours(text_in(column("code"), row)) && timed && known && number_in(column("error"), row) <= error)
      result.see(text_in(column("method"), row), number_in(column("time"), row));
  }
  return result;
}

/// The methods of all tables, in the order in which they come.
std::vector<std::string> methods_of(std::span<const Table> tables) {
  std::vector<std::string> methods;
  for (const Table& table : tables)
    for (std::size_t row = 0; row < rows(table); ++row)
      if (const std::string method = text_in(find_column(table, "method"), row);
          !method.empty() && std::ranges::find(methods, method) == methods.end())
        methods.push_back(method);
  return methods;
}

double geometric_mean(const std::vector<double>& numbers) {
  double sum = 0;
  for (const double number : numbers) sum += std::log(number);
  return std::exp(sum / static_cast<double>(numbers.size()));
}

/// A method at an error: its ratios to the quickest of ours.
struct Rank {
  std::string method;
  double error;
  std::size_t scenes, reached;
  double mean = NAN, least = NAN, largest = NAN;  ///< NaN: it reaches it in none
};

Rank rank(const std::string& method, double error, const std::vector<Quickest>& scenes) {
  std::vector<double> ratios;
  for (const Quickest& scene : scenes)
    if (const auto found = scene.methods.find(method); found != scene.methods.end())
      ratios.push_back(found->second / scene.ours);
  Rank result{method, error, scenes.size(), ratios.size()};
  if (ratios.empty()) return result;
  result.mean = geometric_mean(ratios);
  result.least = std::ranges::min(ratios);
  result.largest = std::ranges::max(ratios);
  return result;
}

constexpr ColumnOf<Rank> rank_columns[] = {
    {"method", "method", "", "with automatic stages and linear solvers", Role::key, field<&Rank::method>},
    {"error", "error", "1", "at most", Role::key, field<&Rank::error>},
    {"scenes", "scenes", "1", "in which any of ours reaches the error", Role::quantity, field<&Rank::scenes>},
    {"reached", "reached", "1", "in which this method does", Role::time, field<&Rank::reached>},
    {"mean", "mean", "1", "geometric mean of the ratios to the quickest of ours", Role::time, field<&Rank::mean>},
    {"least", "least", "1", "of the ratios", Role::time, field<&Rank::least>},
    {"largest", "largest", "1", "of the ratios", Role::time, field<&Rank::largest>},
};

}  // namespace

Table ranking(std::span<const Table> tables) {
  std::vector<Table> trials;
  for (const Table& table : tables)
    if (table.name.starts_with("trials: ")) trials.push_back(table);
  std::vector<Rank> ranks;
  for (const std::string& method : methods_of(trials))
    for (int digit = 1; digit <= digits; ++digit) {
      const double error = std::pow(10.0, -digit);
      std::vector<Quickest> scenes;
      for (const Table& table : trials)
        if (Quickest scene = quickest(table, error); std::isfinite(scene.ours)) scenes.push_back(std::move(scene));
      if (!scenes.empty()) ranks.push_back(rank(method, error, scenes));
    }
  return make_table("ranking", "Times of the methods over the quickest of ours, over all scenes: geometric mean and range",
                    rank_columns, ranks);
}

}  // namespace drape::results
