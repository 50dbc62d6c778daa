#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/studies/field/runs.hpp"

namespace drape::bench {

/// Which settings a method may have.
enum class Settings {
  recommended,  ///< one for all scenes and errors
  tuned,        ///< with hindsight: any that was tried
};
inline constexpr std::array both_settings{Settings::recommended, Settings::tuned};

constexpr std::string_view to_string(Settings settings) { return settings == Settings::tuned ? "tuned" : "recommended"; }

/// The quickest run that was timed repeatedly with an error of at most `error`, among those that `allowed` takes; null if there
/// is none.
const FieldRun* quickest_run(const SheetResult& sheet, double error, const std::function<bool(const FieldRun&)>& allowed);

/// Median CPU time [ms]; of a run that was not repeated that of the first.
double median_time(const FieldRun& run);

/// Whether a winner is ahead of the next family.
enum class Lead {
  clear,  ///< by more than noise
  tie,    ///< the middle halves of the times overlap
  alone,  ///< no other family reaches the error
  none,   ///< there is no winner
};
inline constexpr std::string_view lead_names[] = {"clear", "tie", "alone", "none"};

/// The quickest of all methods on a sheet at an error, and the quickest of the other families.
struct FieldWinner {
  const SheetResult* sheet;
  Settings settings;
  double error;
  const FieldRun* best;  ///< null: nothing reaches the error
  const FieldRun* next;  ///< null: no other family does

  Lead lead() const;
  std::optional<double> margin() const;  ///< time of the next family's over the winner's
  std::string_view family() const { return best == nullptr ? "none" : best->family(); }
};

/// At all errors that the references resolve.
std::vector<FieldWinner> field_winners(const std::vector<SheetResult>& sheets, Settings settings);

/// The families of all methods, and "none".
std::vector<std::string> family_names();

/// A setting that won on one sheet, judged on another: without hindsight.
struct Transfer {
  const SheetResult *training, *sheet;
  double error;
  const FieldRun* chosen;  ///< on the sheet; null: it was not run there to its end
  std::string setting;
  const FieldRun* best;  ///< with hindsight; null: nothing reaches the error

  results::Verdict verdict() const;
  std::optional<double> ratio() const;  ///< of its time to that of the best
};

/// Chosen on the sheet hung by its edge whose h k/d is nearest, of the same number of particles if there is one.
std::vector<Transfer> transfers(const std::vector<SheetResult>& sheets);

/// What the winners of sheets with like damping have in common.
struct FieldAnswer {
  Settings settings;
  std::string_view damping;  ///< in words, by h k/d
  double error;
  std::size_t sheets = 0;             ///< on which some method reaches the error
  std::string_view family = "none";   ///< that wins most often
  std::size_t won = 0;                ///< on that number of sheets
  std::string method = {};            ///< of that family, which wins most often
  std::optional<double> margin = {};  ///< geometric mean to the next family, where that family wins
};
std::vector<FieldAnswer> field_answers(const std::vector<SheetResult>& sheets);

/// What no other run on a sheet beats in both error and time, from the quickest on.
std::vector<const FieldRun*> front_of(const SheetResult& sheet);

}  // namespace drape::bench
