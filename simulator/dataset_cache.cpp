#include "simulator/dataset_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <span>
#include <system_error>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/files/file_lock.h"
#include "core/io/files/folder_name.h"
#include "core/io/files/input_log.h"
#include "core/io/files/sha256.h"
#include "core/io/files/unfinished_sibling.h"
#include "core/process/program.h"
#include "core/process/progress.h"
#include "core/version.h"
#include "simulator/motion/motion.h"
#include "simulator/resume.h"
#include "simulator/scene/build_scene.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLock = "lock";
constexpr const char* kMarker = "dataset.yaml";
constexpr std::size_t kKeyDigits = 16;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// Copies of one build count as one program, which a build of changed sources does not.
std::string program_text() {
  const std::string_view commit = git_commit();
  if (commit == "unknown" || commit.ends_with("-dirty")) return program_identity();
  std::error_code ignored;
  return fmt::format("saccade {} ({}), {} bytes", version(), commit,
                     fs::file_size(program_file(), ignored));
}

/// The finished dataset of an entry; empty where there is none.
fs::path dataset_in(const fs::path& entry) {
  std::error_code error;
  for (const fs::directory_entry& item : fs::directory_iterator(entry, error))
    if (!item.path().filename().string().starts_with('.') && fs::exists(item.path() / kMarker))
      return item.path();
  return {};
}

std::uintmax_t bytes_below(const fs::path& folder) {
  std::uintmax_t bytes = 0;
  std::error_code error;
  for (const fs::directory_entry& item : fs::recursive_directory_iterator(folder, error))
    if (item.is_regular_file(error)) bytes += item.file_size(error);
  return bytes;
}

/// Whether this program made a folder of the cache: it has the name of a key and holds a lock. A cache may
/// have been put where other things are.
bool is_entry(const fs::path& folder) {
  const std::string name = folder.filename().string();
  return name.size() == kKeyDigits &&
         name.find_first_not_of("0123456789abcdef") == std::string::npos &&
         fs::is_directory(fs::symlink_status(folder)) &&
         fs::is_regular_file(fs::symlink_status(folder / kLock));
}

/// The lock goes last: it is held by who removes the entry.
void remove_entry(const fs::path& entry) {
  std::vector<fs::path> contents;
  for (const fs::directory_entry& item : fs::directory_iterator(entry))
    if (item.path().filename() != kLock) contents.push_back(item.path());
  // A dataset without its marker is none, should the removal be cut short.
  for (const fs::path& item : contents) fs::remove(item / kMarker);
  for (const fs::path& item : contents) fs::remove_all(item);
  fs::remove_all(entry);
}

FileLock wait_for_entry(const fs::path& lock) {
  if (std::optional<FileLock> free = FileLock::try_take(lock)) return std::move(*free);
  show_notice(lock.parent_path().string() + ": another program simulates this dataset; waiting");
  return FileLock::wait_for(lock);
}

/// Which of the datasets, the least lately used first, go.
std::vector<CachedDataset> doomed(const std::vector<CachedDataset>& datasets,
                                  const PruneOptions& options) {
  constexpr double kGigabyte = 1e9;
  const auto now = fs::file_time_type::clock::now();
  double total = 0;
  for (const CachedDataset& dataset : datasets) total += static_cast<double>(dataset.bytes);
  std::vector<CachedDataset> chosen;
  for (const CachedDataset& dataset : datasets) {
    const double age_s = std::chrono::duration<double>(now - dataset.used).count();
    const bool old = options.older_than_days && age_s > 86400 * *options.older_than_days;
    const bool too_much = options.keep_gb && total > kGigabyte * *options.keep_gb;
    if (!options.all && !old && !too_much) continue;
    total -= static_cast<double>(dataset.bytes);
    chosen.push_back(dataset);
  }
  return chosen;
}

}  // namespace

fs::path default_cache_folder() {
  if (const std::string stated = environment("SACCADE_CACHE"); !stated.empty()) return stated;
  if (const std::string base = environment("XDG_CACHE_HOME"); !base.empty())
    return fs::path(base) / "saccade";
  if (const std::string home = environment("HOME"); !home.empty())
    return fs::path(home) / ".cache" / "saccade";
  throw InputError("SACCADE_CACHE", "is not set, nor is HOME: name a folder for cached datasets");
}

std::string simulation_key(const SimulationConfig& config) {
  const InputLog inputs;
  (void)build_motion(config.trajectory);
  (void)build_scene(config.scene);
  Fingerprint fingerprint = fingerprint_of(config, inputs);
  fingerprint["the program"] = program_text();
  std::string text;
  for (const auto& [name, content] : fingerprint) text += name + ": " + content + "\n";
  return sha256(std::as_bytes(std::span(text))).substr(0, kKeyDigits);
}

DatasetCache::Obtained DatasetCache::obtain(const SimulationConfig& config,
                                            const std::string& name) const {
  const fs::path entry = folder_ / simulation_key(config);
  const FileLock lock = wait_for_entry(entry / kLock);
  fs::last_write_time(entry / kLock, fs::file_time_type::clock::now());
  if (fs::path known = dataset_in(entry); !known.empty()) return {known, std::nullopt};
  SimulationReport report = simulate(config, entry / name);
  return {entry / name, std::move(report)};
}

std::vector<CachedDataset> DatasetCache::list() const {
  std::vector<CachedDataset> datasets;
  std::error_code error;
  for (const fs::directory_entry& item : fs::directory_iterator(folder_, error)) {
    if (!is_entry(item.path())) continue;
    datasets.push_back({item.path().filename().string(), dataset_in(item.path()),
                        bytes_below(item.path()), fs::last_write_time(item.path() / kLock)});
  }
  std::sort(datasets.begin(), datasets.end(), [](const CachedDataset& a, const CachedDataset& b) {
    return std::tie(a.used, a.key) < std::tie(b.used, b.key);
  });
  return datasets;
}

std::vector<CachedDataset> DatasetCache::prune(const PruneOptions& options) const {
  std::vector<CachedDataset> removed;
  for (const CachedDataset& dataset : doomed(list(), options)) {
    const fs::path entry = folder_ / dataset.key;
    const std::optional<FileLock> lock = FileLock::try_take(entry / kLock);
    if (!lock) continue;
    if (!options.dry_run) remove_entry(entry);
    removed.push_back(dataset);
  }
  return removed;
}

void link_dataset(const fs::path& cached, const fs::path& output) {
  const fs::path name = named_folder(output);
  if (!fs::is_symlink(name)) {
    const FinalFolder target(name, kMarker);
    target.check_replaceable();
    target.create_parent();
    fs::remove_all(name);
  }
  const fs::path link = unfinished_sibling(name, "partial");
  fs::create_directory_symlink(fs::absolute(cached), link);
  fs::rename(link, name);
}

void unlink_dataset(const fs::path& output) {
  const fs::path name = named_folder(output);
  if (!fs::is_symlink(name)) return;
  const fs::path entry = fs::read_symlink(name).parent_path();
  if (entry.parent_path().filename() == "datasets" && fs::exists(entry / kLock)) fs::remove(name);
}

}  // namespace saccade
