#include "results/run_record.hpp"

#include <algorithm>

namespace drape::results {

std::int64_t work_count(const RunRecord& run, const std::string& name) {
  const auto known = std::ranges::find(run.work, name, &WorkCount::name);
  return known == run.work.end() ? 0 : known->count;
}

}  // namespace drape::results
