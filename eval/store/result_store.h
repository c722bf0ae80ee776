#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "eval/store/database.h"
#include "eval/store/result_row.h"

namespace saccade {

constexpr const char* kResultStoreName = "results.sqlite";

/// results.sqlite beside a run folder.
[[nodiscard]] std::filesystem::path result_store_beside(const std::filesystem::path& run_folder);

/// The store that a path names: itself, in the folder, or in the folder's runs/, as a sweep has it.
[[nodiscard]] std::filesystem::path find_result_store(const std::filesystem::path& named);

/// The run folders as `runs/*` names them: without the store that lies among them.
[[nodiscard]] std::vector<std::filesystem::path> without_store(
    std::span<const std::filesystem::path> named);

/// Writes rows to a store, creates it where there is none. Several processes may write at once.
class ResultStore {
 public:
  /// InputError when `file` is something else, or of another version of the format.
  explicit ResultStore(const std::filesystem::path& file);

  /// Adds all rows or, where that fails, none. A row replaces the one of the same run.
  void add(std::span<const ResultRow> rows);

 private:
  Database database_;
};

/// Adds the run to the store beside it.
void store_result(const std::filesystem::path& run_folder);
/// The same of a run whose scores count whatever becomes of the store, for which the folder above
/// the run must be writable: where they are not stored, a notice says so.
void keep_result(const std::filesystem::path& run_folder);

/// Metrics of stored runs: a row for each run, a column for each name.
class MetricTable {
 public:
  MetricTable(std::size_t runs, std::vector<std::string> names)
      : names_(std::move(names)),
        values_(runs * names_.size(), std::numeric_limits<double>::quiet_NaN()) {}

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// NaN: not measured.
  [[nodiscard]] double at(std::size_t run, std::size_t metric) const {
    return values_[run * names_.size() + metric];
  }
  void set(std::size_t run, std::size_t metric, double value) {
    values_[run * names_.size() + metric] = value;
  }
  /// Whether any of the runs has the metric.
  [[nodiscard]] bool any_has(std::size_t metric) const;

 private:
  std::vector<std::string> names_;
  std::vector<double> values_;
};

/// Reads rows of a store that exists. Nothing can be changed through it.
class ResultReader {
 public:
  /// InputError when there is no store, or `file` is something else.
  explicit ResultReader(const std::filesystem::path& file);

  /// Names of all metrics, in alphabetical order.
  [[nodiscard]] std::vector<std::string> metric_names() const;
  /// The stored name that `name` stands for: itself, or its median ("speed.wall_s"); empty: none.
  [[nodiscard]] std::string stored_metric(const std::string& name) const;

  /// Rows for which the condition holds (where_expression.h; empty: all), by dataset, module,
  /// configuration, seed and run, without their metrics. The text of the configuration, long, is
  /// read on demand. InputError with the place in `where`.
  [[nodiscard]] std::vector<ResultRow> select(std::string_view where,
                                              bool with_config_text = false);
  /// The metrics with these names (stored_metric() of them), of rows of select().
  [[nodiscard]] MetricTable metrics(std::span<const ResultRow> rows,
                                    std::vector<std::string> names);

 private:
  Database database_;
  std::map<std::string, std::int64_t, std::less<>> metrics_;  ///< name -> number
};

}  // namespace saccade
