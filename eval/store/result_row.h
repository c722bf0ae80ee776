#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "core/io/tables/csv_file.h"
#include "eval/metrics/metrics.h"

namespace saccade {

/// What a run gave and what it was made of, as one row of a result store.
struct ResultRow {
  std::int64_t id = 0;  ///< in the store; 0: not from one
  std::string run;      ///< name of the folder
  std::string module;   ///< "track", "odometry", ...
  std::string dataset;  ///< name of its folder
  std::string config;   ///< "best", "best start.truth_s=0": file and --set; "defaults"
  std::uint64_t seed = 0;
  int threads = 0;
  std::optional<double> start_s;  ///< window of the dataset; nullopt: the whole
  std::optional<double> end_s;
  std::string version;  ///< "0.1.0"
  std::string commit;   ///< "1234567890ab", with "-dirty" where files differed from it
  std::string machine;
  std::string added;           ///< to the store, UTC, "2026-01-31T12:00:00Z"
  std::string command;         ///< command line of the run
  std::string dataset_path;    ///< folder
  std::string dataset_sha256;  ///< of dataset.yaml, or of the events
  std::string config_sha256;   ///< of config_yaml
  std::string run_sha256;      ///< of run.yaml
  std::string config_yaml;     ///< the resolved configuration; of a stored row where asked for
  Metrics metrics;  ///< of metrics.json; not evaluated: timing.json as speed.*. Of a stored row
                    ///< empty: MetricTable
};

/// A member of ResultRow under the name that people use.
struct ResultColumn {
  using Member = std::variant<std::string ResultRow::*, std::uint64_t ResultRow::*,
                              int ResultRow::*, std::optional<double> ResultRow::*>;

  std::string name;
  Member member;

  [[nodiscard]] CsvTable::Cell of(const ResultRow& row) const;
};

/// All but the id and the metrics, in the order of the struct.
[[nodiscard]] std::span<const ResultColumn> result_columns();

/// This moment as "2026-01-31T12:00:00Z".
[[nodiscard]] std::string utc_now();

/// Reads run.yaml, metrics.json and timing.json of a run folder; the latter two may be missing.
/// InputError where it is no run folder or one of them is malformed.
[[nodiscard]] ResultRow read_result(const std::filesystem::path& run_folder);

}  // namespace saccade
