#include "eval/store/mlflow.h"

#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/files/sha256.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kIdDigits = 32;  // as of a UUID without dashes
constexpr const char* kExperiment = "saccade";

std::string id_of(const std::string& text) {
  return sha256(std::as_bytes(std::span(text))).substr(0, kIdDigits);
}

/// "2026-01-31T12:00:00Z" in milliseconds since 1970; 0 for anything else.
long long milliseconds(const std::string& utc) {
  std::tm time{};
  if (strptime(utc.c_str(), "%Y-%m-%dT%H:%M:%SZ", &time) == nullptr) return 0;
  return 1000LL * static_cast<long long>(timegm(&time));
}

/// A YAML text in single quotes, whatever it holds.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += '\'';
    result += c == '\n' ? ' ' : c;
  }
  return result + "'";
}

std::string file_uri(const fs::path& path) { return "file://" + fs::absolute(path).string(); }

void write_experiment(const fs::path& folder, const std::string& id, long long time_ms) {
  write_atomically(folder / id / "meta.yaml",
                   fmt::format("artifact_location: {}\ncreation_time: {}\nexperiment_id: '{}'\n"
                               "last_update_time: {}\nlifecycle_stage: active\nname: {}\n",
                               quoted(file_uri(folder / id)), time_ms, id, time_ms, kExperiment));
}

std::string run_meta(const ResultRow& row, const fs::path& run, const std::string& id,
                     const std::string& experiment) {
  const long long time_ms = milliseconds(row.added);
  constexpr int kFinished = 3, kLocal = 4;
  return fmt::format(
      "artifact_uri: {}\nend_time: {}\nentry_point_name: ''\nexperiment_id: '{}'\n"
      "lifecycle_stage: active\nrun_id: {}\nrun_name: {}\nrun_uuid: {}\nsource_name: ''\n"
      "source_type: {}\nsource_version: ''\nstart_time: {}\nstatus: {}\ntags: []\nuser_id: ''\n",
      quoted(file_uri(run / "artifacts")), time_ms, experiment, id, quoted(row.run), id, kLocal,
      time_ms, kFinished);
}

/// What a cell of a column shows; empty where nothing is known.
std::string param_text(const CsvTable::Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* number = std::get_if<double>(&cell))
    return std::isnan(*number) ? "" : fmt::format("{}", *number);
  return fmt::format("{}", std::get<long long>(cell));
}

void write_params(const ResultRow& row, const fs::path& run) {
  for (const ResultColumn& column : result_columns()) {
    // Long texts are tags or artifacts: MLflow cuts params.
    const bool is_elsewhere = column.name == "run" || column.name == "command" ||
                              column.name == "config_yaml" || column.name == "commit";
    const std::string text = is_elsewhere ? "" : param_text(column.of(row));
    if (!text.empty()) write_atomically(run / "params" / column.name, text);
  }
}

void write_run(const ResultRow& row, const MetricTable& metrics, std::size_t index,
               const std::vector<std::string>& names, const fs::path& folder,
               const std::string& experiment) {
  const std::string id = id_of(row.run + "\n" + row.run_sha256);
  AtomicFolder output(folder / experiment / id, "meta.yaml");
  const fs::path& run = output.path();
  const long long time_ms = milliseconds(row.added);
  write_params(row, run);
  for (std::size_t k = 0; k < names.size(); ++k)
    if (const double value = metrics.at(index, k); !std::isnan(value))
      write_atomically(run / "metrics" / names[k], fmt::format("{} {} 0\n", time_ms, value));
  write_atomically(run / "tags" / "mlflow.runName", row.run);
  write_atomically(run / "tags" / "mlflow.source.git.commit", row.commit);
  write_atomically(run / "tags" / "command", row.command);
  write_atomically(run / "artifacts" / "config.yaml", row.config_yaml);
  write_atomically(run / "meta.yaml", run_meta(row, output.target(), id, experiment));
  output.commit();
}

}  // namespace

std::size_t write_mlflow(ResultReader& reader, std::string_view where, const fs::path& folder) {
  const std::vector<ResultRow> rows = reader.select(where, true);
  const std::vector<std::string> names = reader.metric_names();
  for (const std::string& name : names)
    if (name.empty() || name.front() == '.' || name.find('/') != std::string::npos)
      throw InputError("--format mlflow", "the metric '" + name + "' cannot be the name of a file");
  const MetricTable metrics = reader.metrics(rows, names);
  // A number as MLflow draws them, always the same one: small ones are those of other experiments.
  const std::string experiment = "530871943702615348";
  write_experiment(folder, experiment, rows.empty() ? 0 : milliseconds(rows.front().added));
  for (std::size_t i = 0; i < rows.size(); ++i)
    write_run(rows[i], metrics, i, names, folder, experiment);
  return rows.size();
}

}  // namespace saccade
