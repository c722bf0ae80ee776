#include "eval/store/result_row.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <limits>
#include <type_traits>
#include <vector>

#include "core/error.h"
#include "core/io/files/folder_name.h"
#include "core/io/files/sha256.h"
#include "core/io/run/run_record.h"
#include "eval/configuration_name.h"
#include "eval/run_folder.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

Metrics scores_or_speed(const fs::path& folder) {
  if (fs::exists(folder / "metrics.json")) return read_json_metrics(folder / "metrics.json");
  Metrics speed;
  if (!fs::exists(folder / "timing.json")) return speed;
  const Metrics timing = read_json_metrics(folder / "timing.json");
  for (const auto& [key, value] : timing.values()) speed.set("speed." + key, value);
  return speed;
}

}  // namespace

CsvTable::Cell ResultColumn::of(const ResultRow& row) const {
  const auto cell = [&](auto pointer) -> CsvTable::Cell {
    const auto& value = row.*pointer;
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, std::optional<double>>)
      return value.value_or(std::numeric_limits<double>::quiet_NaN());
    else if constexpr (std::is_same_v<Value, int>)
      return static_cast<long long>(value);
    else if constexpr (std::is_same_v<Value, std::uint64_t>)
      return std::to_string(value);
    else
      return value;
  };
  return std::visit(cell, member);
}

std::string utc_now() {
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now));
}

std::span<const ResultColumn> result_columns() {
  static const std::vector<ResultColumn> columns{
      {"run", &ResultRow::run},
      {"module", &ResultRow::module},
      {"dataset", &ResultRow::dataset},
      {"config", &ResultRow::config},
      {"seed", &ResultRow::seed},
      {"threads", &ResultRow::threads},
      {"start_s", &ResultRow::start_s},
      {"end_s", &ResultRow::end_s},
      {"version", &ResultRow::version},
      {"commit", &ResultRow::commit},
      {"machine", &ResultRow::machine},
      {"added", &ResultRow::added},
      {"command", &ResultRow::command},
      {"dataset_path", &ResultRow::dataset_path},
      {"dataset_sha256", &ResultRow::dataset_sha256},
      {"config_sha256", &ResultRow::config_sha256},
      {"run_sha256", &ResultRow::run_sha256},
      {"config_yaml", &ResultRow::config_yaml},
  };
  return columns;
}

ResultRow read_result(const fs::path& run_folder) {
  const fs::path file = run_record_of(run_folder);
  const RunRecord record = read_run_record(file);
  ResultRow row;
  row.run = folder_name(run_folder);
  row.module = record.module;
  row.dataset = folder_name(record.dataset);
  row.config_sha256 = configuration_sha256(record);
  row.config = configuration_name(record);
  row.seed = record.seed;
  row.threads = record.threads;
  if (record.window) row.start_s = record.window->start_s;
  if (record.window) row.end_s = record.window->end_s;
  row.version = record.version();
  row.commit = record.commit();
  row.machine = record.machine;
  row.added = utc_now();
  row.command = record.command;
  row.dataset_path = record.dataset.string();
  row.dataset_sha256 = record.dataset_sha256;
  row.run_sha256 = sha256_of_file(file);
  row.config_yaml = record.config_yaml;
  row.metrics = scores_or_speed(run_folder);
  return row;
}

}  // namespace saccade
