#include <utility>

#include "bench/studies/field/tables.hpp"
#include "bench/studies/studies.hpp"

/// Which integrator should one use? All rows of the table of methods on several sheets, with one setting for all and with the
/// best of some.
namespace drape::bench {

Job field_job(std::vector<FieldSheet> list, const Methods& methods) {
  const int parts = static_cast<int>(list.size() * all_or(methods).size());
  const auto compute = [list = std::move(list), methods](Checkpoint& checkpoint) {
    std::vector<SheetResult> sheets;
    checkpoint.each(list, [&](const FieldSheet& sheet) { sheets.push_back(run_sheet(sheet, methods, checkpoint)); });
    return sheets;
  };
  return job("field", parts, compute, field_tables);
}

std::vector<Job> field_study(const Question& question) { return {field_job(field_sheets(question.quick), question.methods)}; }

}  // namespace drape::bench
