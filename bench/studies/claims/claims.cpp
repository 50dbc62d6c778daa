#include <fmt/format.h>

#include "bench/studies/claims/claim.hpp"
#include "bench/studies/studies.hpp"
#include "results/columns.hpp"

/// The ledger: what is said of integrators, and what becomes of it when it is measured.
namespace drape::bench {
namespace {

using results::ColumnOf;
using results::Datum;
using results::field;
using results::Role;
using results::to_datum;

/// A claim with what was measured.
struct LedgerRow {
  const Claim* claim;
  std::vector<ClaimCase> cases;
};

Datum text_of_claim(const LedgerRow& row, std::string_view Claim::*member) { return to_datum(row.claim->*member); }

/// A number in the column of times or in that of all others, which is the same on every machine.
Datum number_if(bool belongs_here, double number) { return belongs_here ? Datum(number) : Datum(); }

std::string confirmed_of(const LedgerRow& row) {
  int confirmed = 0;
  for (const ClaimCase& one : row.cases) confirmed += judge(one) == Holds::confirmed;
  return fmt::format("{} of {}", confirmed, row.cases.size());
}

constexpr ColumnOf<LedgerRow> ledger_columns[] = {
    {"id", "", "", "number in the ledger: C and E of the thesis, F of the field", Role::key,
     [](const LedgerRow& row) { return text_of_claim(row, &Claim::id); }},
    {"source", "source", "", "who says it", Role::note,
     [](const LedgerRow& row) { return text_of_claim(row, &Claim::source); }},
    {"place", "place", "", "where", Role::note, [](const LedgerRow& row) { return text_of_claim(row, &Claim::place); }},
    {"claim", "claim", "", "what, in a few words", Role::note,
     [](const LedgerRow& row) { return text_of_claim(row, &Claim::claim); }},
    {"measured", "measured", "", "what the number is", Role::note,
     [](const LedgerRow& row) { return text_of_claim(row, &Claim::measured); }},
    {"where", "where", "", "the case that decides", Role::note,
     [](const LedgerRow& row) { return to_datum(deciding(row.cases).where); }},
    {"value", "value", "1", "number of that case, in its unit", Role::quantity,
     [](const LedgerRow& row) { return number_if(!row.claim->timed, deciding(row.cases).value); }},
    {"uncertainty", "±", "1", "its uncertainty", Role::quantity,
     [](const LedgerRow& row) { return number_if(!row.claim->timed, deciding(row.cases).uncertainty); }},
    {"time_value", "of times", "1", "ratio of times, in place of a value", Role::time,
     [](const LedgerRow& row) { return number_if(row.claim->timed, deciding(row.cases).value); }},
    {"time_uncertainty", "±", "1", "its uncertainty", Role::time,
     [](const LedgerRow& row) { return number_if(row.claim->timed, deciding(row.cases).uncertainty); }},
    {"number_unit", "unit", "", "unit of the number", Role::note,
     [](const LedgerRow& row) { return text_of_claim(row, &Claim::unit); }},
    {"confirmed", "confirmed", "", "cases that are as claimed", Role::note,
     [](const LedgerRow& row) { return to_datum(confirmed_of(row)); }},
    {"verdict", "verdict", "", "confirmed, refuted, or only under some conditions", Role::verdict,
     [](const LedgerRow& row) { return to_datum(judge(row.cases)); }},
    {"command", "", "", "what shows the same with more beside it", Role::note,
     [](const LedgerRow& row) { return text_of_claim(row, &Claim::command); }},
};

/// A number with the claim that it is of.
struct CaseRow {
  const Claim* claim;
  ClaimCase one;
};

std::string_view in_a_word(Holds holds) {
  switch (holds) {
    case Holds::confirmed: return "confirmed";
    case Holds::refuted: return "refuted";
    case Holds::undecided: break;
  }
  return "undecided";
}

constexpr std::string_view words_of_cases[] = {"confirmed", "undecided", "refuted"};

Datum bound_or_none(double bound) { return std::isfinite(bound) ? Datum(bound) : Datum(); }

constexpr ColumnOf<CaseRow> case_columns[] = {
    {"id", "claim", "", "number in the ledger", Role::key, [](const CaseRow& row) { return to_datum(row.claim->id); }},
    {"where", "where", "", "the condition", Role::key, [](const CaseRow& row) { return to_datum(row.one.where); }},
    {"value", "value", "1", "number, in its unit", Role::quantity,
     [](const CaseRow& row) { return number_if(!row.claim->timed, row.one.value); }},
    {"uncertainty", "±", "1", "its uncertainty", Role::quantity,
     [](const CaseRow& row) { return number_if(!row.claim->timed, row.one.uncertainty); }},
    {"time_value", "of times", "1", "ratio of times, in place of a value", Role::time,
     [](const CaseRow& row) { return number_if(row.claim->timed, row.one.value); }},
    {"time_uncertainty", "±", "1", "its uncertainty", Role::time,
     [](const CaseRow& row) { return number_if(row.claim->timed, row.one.uncertainty); }},
    {"lower", "from", "1", "the claim holds from here on", Role::note,
     [](const CaseRow& row) { return bound_or_none(row.one.lower); }},
    {"upper", "to", "1", "and up to here", Role::note, [](const CaseRow& row) { return bound_or_none(row.one.upper); }},
    {"unit", "unit", "", "unit of the number", Role::note, [](const CaseRow& row) { return to_datum(row.claim->unit); }},
    {"verdict", "verdict", "", "what the number comes to", Role::verdict,
     [](const CaseRow& row) { return to_datum(in_a_word(judge(row.one))); }, nullptr, words_of_cases},
};

std::vector<LedgerRow> measure_claims(Checkpoint& checkpoint) {
  std::vector<LedgerRow> rows;
  checkpoint.each(all_claims(), [&](const Claim* claim) {
    checkpoint.show(fmt::format("{}: {}", claim->id, claim->claim));
    const std::string id(claim->id);
    rows.push_back({claim, claim->timed ? checkpoint.timed(id, claim->measure) : checkpoint.once(id, claim->measure)});
    checkpoint.advance();
  });
  return rows;
}

std::vector<results::Table> claims_tables(const std::vector<LedgerRow>& ledger) {
  std::vector<CaseRow> cases;
  for (const LedgerRow& row : ledger)
    for (const ClaimCase& one : row.cases) cases.push_back({row.claim, one});
  return {results::make_table("claims", "What is said of integrators, and what becomes of it when it is measured",
                              ledger_columns, ledger),
          results::make_table("claims-cases", "The numbers behind the claims, and where they would have to be", case_columns,
                              cases)};
}

}  // namespace

std::vector<const Claim*> all_claims() {
  std::vector<const Claim*> all;
  for (const auto group :
       {force_claims(), mode_claims(), system_claims(), order_claims(), sheet_claims(), panel_claims(), alternative_claims()})
    for (const Claim& claim : group) all.push_back(&claim);
  return all;
}

std::vector<Job> claims(const Question&) {
  return {job("claims", static_cast<int>(all_claims().size()), measure_claims, claims_tables)};
}

}  // namespace drape::bench
