#include <fmt/chrono.h>
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "apps/option_checks.h"
#include "apps/verbs.h"
#include "core/error.h"
#include "simulator/dataset_cache.h"

namespace saccade {
namespace {

struct CacheOptions {
  std::string action;
  PruneOptions prune;
};

double megabytes(const std::vector<CachedDataset>& datasets) {
  double bytes = 0;
  for (const CachedDataset& dataset : datasets) bytes += static_cast<double>(dataset.bytes);
  return 1e-6 * bytes;
}

void show(const std::vector<CachedDataset>& datasets) {
  for (const CachedDataset& dataset : datasets) {
    const auto used = std::chrono::file_clock::to_sys(dataset.used);
    const std::time_t seconds = std::chrono::system_clock::to_time_t(
        std::chrono::time_point_cast<std::chrono::system_clock::duration>(used));
    fmt::print("{}  {:>9.1f} MB  used {:%Y-%m-%d %H:%M}  {}\n", dataset.key,
               1e-6 * static_cast<double>(dataset.bytes), fmt::localtime(seconds),
               dataset.folder.empty() ? "unfinished" : dataset.folder.filename().string());
  }
}

void work_on_cache(const CacheOptions& options) {
  const std::filesystem::path root = default_cache_folder();
  const DatasetCache cache(root);
  const bool chosen = options.prune.all || options.prune.older_than_days || options.prune.keep_gb;
  if (options.action == "list") {
    if (chosen || options.prune.dry_run)
      throw InputError("cache list", "--all, --older-than-days, --keep-gb, --dry-run are of prune");
    const std::vector<CachedDataset> datasets = cache.list();
    show(datasets);
    fmt::print("{}: {} datasets, {:.1f} MB\n", root.string(), datasets.size(), megabytes(datasets));
    return;
  }
  if (!chosen)
    throw InputError("cache prune", "say what goes: --all, --older-than-days N or --keep-gb N");
  const std::vector<CachedDataset> removed = cache.prune(options.prune);
  show(removed);
  fmt::print("{}: {} datasets, {:.1f} MB {}\n", root.string(), removed.size(), megabytes(removed),
             options.prune.dry_run ? "would be removed" : "removed");
}

}  // namespace

void add_cache_verb(CLI::App& command) {
  const auto options = std::make_shared<CacheOptions>();
  CLI::App* verb = command.add_subcommand(
      "cache", "List or remove the simulated datasets that sweeps share ($SACCADE_CACHE).");
  verb->add_option("ACTION", options->action,
                   "list: show the cached datasets; prune: remove some of them.")
      ->required()
      ->check(CLI::IsMember({"list", "prune"}));
  verb->add_flag("--all", options->prune.all, "Remove every cached dataset.");
  verb->add_option("--older-than-days", options->prune.older_than_days,
                   "Remove the datasets that nobody used for N days.")
      ->type_name("N")
      ->check(number_between(0, 1e5));
  verb->add_option("--keep-gb", options->prune.keep_gb,
                   "Remove the least recently used datasets until N GB remain.")
      ->type_name("N")
      ->check(number_between(0, 1e9));
  verb->add_flag("--dry-run", options->prune.dry_run, "Only print what would be removed.");
  verb->footer(
      "Examples:\n"
      "  saccade cache list\n"
      "  saccade cache prune --keep-gb 20\n"
      "  saccade cache prune --older-than-days 30 --dry-run");
  verb->callback([options] { work_on_cache(*options); });
}

}  // namespace saccade
