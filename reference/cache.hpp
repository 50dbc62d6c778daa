#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "reference/reference.hpp"
#include "solver/base/lock_file.hpp"

namespace drape::reference {

/// $DRAPE_CACHE, else $XDG_CACHE_HOME/drape, else $HOME/.cache/drape, else empty.
std::filesystem::path default_cache_folder();

/// References on disk, one file for each key.
///
/// To the caller's key text is added what the caller does not have: the source code of solver/, model/ and reference/, the
/// compiler and its flags, and the versions of the libraries. A file holds the complete text, compared on reading, and a
/// checksum; a file that fails either test, or the caller's own, counts as absent. Files are never removed, except what killed
/// processes left unfinished: the folder may be deleted at any time. Nothing about the disk stops a run: what cannot be read is
/// computed, what cannot be written is not kept.
class Cache {
 public:
  explicit Cache(std::filesystem::path folder = default_cache_folder());

  /// Throws DamagedFile if a reference does not match the request.
  using Check = std::function<void(const Reference&)>;

  /// A file whose content `check` objects to counts as damaged.
  std::optional<Reference> find(std::string_view key, const Check& check = {});
  void store(std::string_view key, const Reference& reference);

  /// Waits until no other process has the lock of the same key, and takes it; every tenth of a second calls `waiting`, which
  /// may throw. Where nothing can be locked, as where nothing can be kept, it does not wait.
  std::unique_ptr<base::LockFile> lock(std::string_view key, const std::function<void()>& waiting = {}) const;

  /// The file of a key, whether it is there or not.
  std::filesystem::path file(std::string_view key) const;

  struct Counts {
    int hits = 0;
    int absent = 0;
    int rejected = 0;  ///< files that were damaged or belonged to another key
    int not_stored = 0;
  };
  const Counts& counts() const { return counts_; }

  /// One sentence for each file that was rejected or could not be written, for the user.
  const std::vector<std::string>& messages() const { return messages_; }

 private:
  std::filesystem::path folder_;
  Counts counts_;
  std::vector<std::string> messages_;
};

/// The caller's part of a key: the complete scene, from which the ODE and y0 follow, and the arguments of reference().
std::string cache_key(std::string_view scene_toml, double t0, std::span<const double> times, const SolveOptions& options);

/// The reference from the cache, or else from `compute` and into the cache. Of several processes that need the same one at a
/// time one computes it, and the others wait, as lock() does. Exceptions of `compute` and `waiting` pass through.
Reference cached(Cache& cache, std::string_view key, const std::function<Reference()>& compute, const Cache::Check& check = {},
                 const std::function<void()>& waiting = {});

}  // namespace drape::reference
