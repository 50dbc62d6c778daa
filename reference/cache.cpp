#include "reference/cache.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <chrono>
#include <cstdlib>
#include <span>
#include <system_error>
#include <thread>

#include "reference/fingerprint.hpp"
#include "reference/reference_file.hpp"
#include "reference/sundials/sundials_build.hpp"
#include "solver/base/atomic_file.hpp"
#include "solver/base/hash.hpp"
#include "solver/base/input_file.hpp"
#include "solver/base/lock_file.hpp"
#include "solver/base/temporary.hpp"

namespace drape::reference {
namespace {

constexpr std::uintmax_t largest_file = std::uintmax_t{4} << 30;  // [bytes]

std::string complete(std::string_view key) {
  return fmt::format("{}\n{}, Eigen {}.{}.{}\n{}\n", key, sundials_versions(), EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                     EIGEN_MINOR_VERSION, fingerprint);
}

}  // namespace

std::filesystem::path default_cache_folder() {
  const auto from = [](const char* variable) {
    const char* value = std::getenv(variable);
    return std::filesystem::path(value ? value : "");
  };
  if (auto folder = from("DRAPE_CACHE"); !folder.empty()) return folder;
  if (const auto folder = from("XDG_CACHE_HOME"); !folder.empty()) return folder / "drape";
  if (const auto folder = from("HOME"); !folder.empty()) return folder / ".cache" / "drape";
  return {};
}

Cache::Cache(std::filesystem::path folder) : folder_(std::move(folder)) { base::remove_leftovers(folder_); }

std::filesystem::path Cache::file(std::string_view key) const {
  return folder_ / (base::long_hash_text(complete(key)) + ".reference");
}

std::optional<Reference> Cache::find(std::string_view key, const Check& check) {
  const std::filesystem::path path = file(key);
  if (std::error_code unreachable; !std::filesystem::exists(path, unreachable)) {
    ++counts_.absent;
    return std::nullopt;
  }
  try {
    Reference reference = decode(base::content_of(path, largest_file), complete(key));
    if (check) check(reference);
    ++counts_.hits;
    return reference;
  } catch (const std::runtime_error& error) {
    ++counts_.rejected;
    messages_.push_back(fmt::format("the cached reference {} is not used: {}", path.string(), error.what()));
    return std::nullopt;
  }
}

std::unique_ptr<base::LockFile> Cache::lock(std::string_view key, const std::function<void()>& waiting) const {
  if (folder_.empty()) return nullptr;
  std::error_code ignored;  // without a folder nothing is kept, which store() says
  std::filesystem::create_directories(folder_, ignored);
  auto lock = std::make_unique<base::LockFile>(file(key).string() + ".lock");
  while (!lock->try_lock()) {
    if (waiting) waiting();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return lock;
}

void Cache::store(std::string_view key, const Reference& reference) {
  const std::filesystem::path path = file(key);
  try {
    if (folder_.empty()) throw std::runtime_error("none of DRAPE_CACHE, XDG_CACHE_HOME and HOME names a folder");
    const std::string bytes = encode(complete(key), reference);
    base::create_folder(folder_);
    base::publish(path, std::as_bytes(std::span(bytes)), base::Existing::replace);
  } catch (const std::exception& error) {
    ++counts_.not_stored;
    messages_.push_back(fmt::format("the reference is not kept for the next run: {}", error.what()));
  }
}

std::string cache_key(std::string_view scene_toml, double t0, std::span<const double> times, const SolveOptions& options) {
  return fmt::format("{}\nt0 = {}\ntimes = [{}]\nrtol = {}\nsize = {}", scene_toml, t0, fmt::join(times, ", "), options.rtol,
                     options.size);
}

Reference cached(Cache& cache, std::string_view key, const std::function<Reference()>& compute, const Cache::Check& check,
                 const std::function<void()>& waiting) {
  const std::unique_ptr<base::LockFile> lock = cache.lock(key, waiting);
  if (auto known = cache.find(key, check)) return *std::move(known);
  Reference reference = compute();
  cache.store(key, reference);
  return reference;
}

}  // namespace drape::reference
