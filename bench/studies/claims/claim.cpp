#include "bench/studies/claims/claim.hpp"

#include <algorithm>

namespace drape::bench {
namespace {

using results::Standing;

/// The conditions under which it is confirmed: "d = 50 N s/m, d = 5 N s/m".
std::string confirmed_where(std::span<const ClaimCase> cases) {
  std::string all;
  for (const ClaimCase& one : cases)
    if (judge(one) == Holds::confirmed) all += (all.empty() ? "" : ", ") + one.where;
  return all;
}

std::ptrdiff_t count_of(std::span<const ClaimCase> cases, Holds holds) {
  return std::ranges::count_if(cases, [holds](const ClaimCase& one) { return judge(one) == holds; });
}

}  // namespace

Holds judge(const ClaimCase& one) {
  const double least = one.value - one.uncertainty, most = one.value + one.uncertainty;
  if (std::isnan(least) || std::isnan(most)) return Holds::undecided;
  if (least >= one.lower && most <= one.upper) return Holds::confirmed;
  return most < one.lower || least > one.upper ? Holds::refuted : Holds::undecided;
}

results::Verdict judge(std::span<const ClaimCase> cases) {
  const std::ptrdiff_t all = std::ssize(cases), confirmed = count_of(cases, Holds::confirmed);
  if (all > 0 && confirmed == all) return {Standing::met, "confirmed"};
  if (all > 0 && count_of(cases, Holds::refuted) == all) return {Standing::missed, "refuted"};
  if (confirmed > 0) return {Standing::open, "only if " + confirmed_where(cases)};
  return {Standing::open, "undecided"};
}

const ClaimCase& deciding(std::span<const ClaimCase> cases) {
  for (const Holds holds : {Holds::refuted, Holds::undecided})
    for (const ClaimCase& one : cases)
      if (judge(one) == holds) return one;
  return cases.front();
}

}  // namespace drape::bench
