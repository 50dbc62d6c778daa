#pragma once

#include <string>
#include <vector>

#include "bench/runs/recording.hpp"

namespace drape::bench {

/// Prints how much a sweep computes and how long it will take: as long as a finished record of the same sweep took; or, for
/// runs without such a record, as long as short probes of each run and each reference let expect. Records nothing, but keeps
/// references that the probes complete. `name`: that of the job.
void print_plan(const std::vector<Group>& groups, const SweepOptions& options, const std::string& name);

/// The same for jobs that make tables, of which only records tell how long they take. `sweep`: identity of the jobs.
void print_plan(const std::vector<Job>& jobs, const std::string& sweep, const std::string& name);

}  // namespace drape::bench
