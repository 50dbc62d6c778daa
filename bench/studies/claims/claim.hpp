#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/runs/checkpoint_json.hpp"
#include "results/verdict.hpp"

/// The pieces of the study `claims`: a ledger of sentences, each with the numbers that tell whether it holds.
namespace drape::bench {

/// A number that tells whether a claim holds under some condition: it holds if the number is between two others.
struct ClaimCase {
  std::string where;  ///< the condition, for example "d = 50 N s/m"
  double value;
  double uncertainty;
  double lower, upper;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ClaimCase, where, value, uncertainty, lower, upper)

inline constexpr double unbounded = std::numeric_limits<double>::infinity();

/// What a number comes to: confirmed if all that it may be lies between the bounds, refuted if nothing of it does, else
/// undecided, as where it is not a number.
enum class Holds { confirmed, refuted, undecided };
Holds judge(const ClaimCase& one);

/// Confirmed or refuted where all cases are; where they differ, "only if" with those that are confirmed; else undecided.
results::Verdict judge(std::span<const ClaimCase> cases);

/// The case that decides: the first refuted one, else the first undecided one, else the first. There is one.
const ClaimCase& deciding(std::span<const ClaimCase> cases);

/// A sentence of a source and how it is tried.
struct Claim {
  std::string_view id;        ///< "C-07"; of the field "F-03"
  std::string_view source;    ///< "Etzmuß 2002"
  std::string_view place;     ///< section, table or equation
  std::string_view claim;     ///< in a few words
  std::string_view measured;  ///< what the number is
  std::string_view unit;
  std::vector<ClaimCase> (*measure)();
  std::string_view command = "bench/run study claims";  ///< that shows the same with more beside it
  bool timed = false;                                   ///< whether the number is a ratio of times
};

/// The groups of claims, a file each: of forces, of linear modes, of linear systems, of orders, of sheets in motion, of panels
/// that are no rectangles, and of methods other than those of the thesis.
std::span<const Claim> force_claims();
std::span<const Claim> mode_claims();
std::span<const Claim> system_claims();
std::span<const Claim> order_claims();
std::span<const Claim> sheet_claims();
std::span<const Claim> panel_claims();
std::span<const Claim> alternative_claims();

/// All of them, group by group.
std::vector<const Claim*> all_claims();

}  // namespace drape::bench
