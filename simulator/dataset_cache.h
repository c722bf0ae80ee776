#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "simulator/simulate.h"
#include "simulator/simulation_config.h"

namespace saccade {

/// $SACCADE_CACHE, else saccade/ in $XDG_CACHE_HOME or in ~/.cache. InputError where none of them
/// is set.
[[nodiscard]] std::filesystem::path default_cache_folder();

/// What a simulation depends on, as 16 hexadecimal digits: the first of the SHA-256 over the
/// resolved configuration, the contents of all files it names (which are read), and the program:
/// version, commit and size of its file; where sources differed from the commit, also its time.
[[nodiscard]] std::string simulation_key(const SimulationConfig& config);

struct CachedDataset {
  std::string key;
  std::filesystem::path folder;  ///< of the dataset; empty: unfinished
  std::uintmax_t bytes = 0;
  std::filesystem::file_time_type used;  ///< asked for the last time
};

/// Which datasets go; conditions are joined by "or".
struct PruneOptions {
  bool all = false;
  std::optional<double> older_than_days;  ///< since they were asked for
  std::optional<double> keep_gb;          ///< the ones used most lately that fit in 1e9 bytes each
  bool dry_run = false;                   ///< only say what would go
};

/// Simulated datasets by what they depend on: ROOT/datasets/KEY/NAME, beside
/// ROOT/datasets/KEY/lock, whose time is that of the last use. Several programs may use it at once.
class DatasetCache {
 public:
  struct Obtained {
    std::filesystem::path folder;
    std::optional<SimulationReport> report;  ///< nullopt: it was there
  };

  explicit DatasetCache(const std::filesystem::path& root) : folder_(root / "datasets") {}

  /// The dataset of `config`, which is simulated where it is not there yet; a killed program's work
  /// is resumed, another program's that is at it waited for. `name`: of a new dataset.
  [[nodiscard]] Obtained obtain(const SimulationConfig& config, const std::string& name) const;

  /// What was not used for the longest time comes first.
  [[nodiscard]] std::vector<CachedDataset> list() const;
  /// Removes datasets, and says which; not those that are being simulated at this moment.
  [[nodiscard]] std::vector<CachedDataset> prune(const PruneOptions& options) const;

 private:
  std::filesystem::path folder_;
};

/// Makes `output` a link to a cached dataset. A link that stands there is replaced, a dataset or an
/// empty folder too; InputError for anything else.
void link_dataset(const std::filesystem::path& cached, const std::filesystem::path& output);

/// Removes `output` where it is a link into a cache, so that a simulation that writes there does
/// not replace what the cache holds.
void unlink_dataset(const std::filesystem::path& output);

}  // namespace saccade
