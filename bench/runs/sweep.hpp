#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/runs/recording.hpp"

namespace drape::bench {

/// Runs all groups and returns all runs; after each group its runs are in the file. Progress on a terminal; remarks on standard
/// error. Throws reference::NotCertified, with all earlier groups on disk, where two families disagree about a scene;
/// Interrupted; base::FileError.
std::vector<results::RunRecord> sweep(const std::vector<Group>& groups, const SweepOptions& options);

/// Computes the shard of the groups that the options name, and returns what there is to say about it. Throws like sweep().
std::string compute_shard(const std::vector<Group>& groups, const SweepOptions& options);

/// A file in results/runs/ named after the time, the job and this process, in a folder made if need be. Throws FileError.
std::filesystem::path default_out(const std::string& job);

}  // namespace drape::bench
