#include "eval/sweep/result/manifest.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>

#include "core/config/convert.h"
#include "core/io/dataset/dataset_record.h"
#include "core/io/files/atomic_file.h"
#include "core/io/files/sha256.h"
#include "core/io/tables/csv_file.h"
#include "core/version.h"
#include "eval/sweep/plan/disk_quota.h"
#include "eval/sweep/plan/generate.h"
#include "eval/sweep/result/dataset_card.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kSampledKey = "drawn";

const char* status_text(JobState state) {
  if (state == JobState::kFailed) return "failed";
  return state == JobState::kPending || state == JobState::kHeld ? "waiting" : "ok";
}

/// A number where the text is one, an integer where it is written as one.
Json json_value(const std::string& text) {
  const auto number = config::number_of(config::Node::scalar(text, false));
  if (!number) return text;
  const bool whole = text.find_first_not_of("-0123456789") == std::string::npos;
  return whole ? Json(static_cast<std::int64_t>(*number)) : Json(*number);
}

void add_facts(const fs::path& folder, Json& row) {
  const DatasetRecord record = read_dataset_record(folder / "dataset.yaml");
  const DatasetRecord::Counts counts = record.counts.value_or(DatasetRecord::Counts{});
  const std::int64_t events = counts.events_on + counts.events_off;
  row["width"] = record.width;
  row["height"] = record.height;
  row["duration_s"] = record.duration_s;
  row["events"] = events;
  row["events_on"] = counts.events_on;
  row["events_off"] = counts.events_off;
  row["mean_rate_hz"] = static_cast<double>(events) / record.duration_s;
  row["frames"] = counts.frames;
  row["depth_maps"] = counts.depth_maps;
  row["flow_maps"] = counts.flow_maps;
  row["masks"] = counts.masks;
  row["normal_maps"] = counts.normal_maps;
  row["optical_flows"] = counts.optical_flows;
  row["imu_samples"] = counts.imu_samples;
  row["path_length_m"] = record.path_length_m ? Json(*record.path_length_m) : Json();
  row["mean_scene_depth_m"] = record.mean_scene_depth_m ? Json(*record.mean_scene_depth_m) : Json();
  row["bytes"] = bytes_below(folder);
  row["dataset_yaml_sha256"] = sha256_of_file(folder / "dataset.yaml");
  row["config_sha256"] = sha256(std::as_bytes(std::span(record.config_yaml)));
}

Json manifest_row(const GeneratedDataset& dataset, const SweepJob& job, const fs::path& folder) {
  Json row;
  row["index"] = dataset.index;
  row["name"] = job.name;
  row["path"] = job.output.lexically_relative(fs::absolute(folder).lexically_normal()).string();
  row["status"] = status_text(job.state);
  row["scene"] = dataset.scene->name;
  if (dataset.part != nullptr) row["case"] = dataset.part->name;
  row["split"] = dataset.split;
  row["seed"] = dataset.seed;
  row[kSampledKey] = Json::object();
  for (const auto& [key, value] : dataset.sampled) row[kSampledKey][key] = json_value(value);
  if (job.state == JobState::kDone || job.state == JobState::kSkipped) add_facts(job.output, row);
  return row;
}

/// The configurations that datasets are made from, as they are now.
Json scene_rows(const GenerateConfig& generate) {
  Json rows = Json::array();
  for (const GenerateScene& scene : generate.scenes) {
    Json row;
    row["name"] = scene.name;
    row["file"] = scene.simulate.filename().string();
    row["sha256"] = sha256_of_file(scene.simulate);
    rows.push_back(std::move(row));
  }
  return rows;
}

/// train.txt, val.txt and test.txt: the paths of the datasets that exist.
void write_splits(const Json& datasets, const fs::path& folder) {
  for (const char* split : {"train", "val", "test"}) {
    std::string paths;
    for (const Json& row : datasets)
      if (row["split"] == split && row["status"] == "ok")
        paths += row["path"].get<std::string>() + "\n";
    write_atomically(folder / (std::string(split) + ".txt"), paths);
  }
}

CsvTable::Cell cell_of(const Json& row, const std::string& key) {
  const auto value = row.find(key);
  if (value == row.end() || value->is_null()) return std::string();
  if (value->is_number_integer()) return value->get<long long>();
  if (value->is_number()) return value->get<double>();
  return value->get<std::string>();
}

/// The keys of all rows, in the order of their first occurrence.
std::vector<std::string> keys_of(const std::vector<Json>& rows) {
  std::vector<std::string> keys;
  std::set<std::string> known;
  for (const Json& row : rows)
    for (const auto& [key, value] : row.items())
      if (known.insert(key).second) keys.push_back(key);
  return keys;
}

/// One table; the sampled parameters are the last columns.
CsvTable manifest_csv(const Json& datasets) {
  std::vector<Json> rows, sampled;
  for (Json row : datasets) {
    sampled.push_back(row[kSampledKey]);
    row.erase(kSampledKey);
    rows.push_back(std::move(row));
  }
  const std::vector<std::string> row_keys = keys_of(rows), sampled_keys = keys_of(sampled);
  std::vector<std::string> columns = row_keys;
  columns.insert(columns.end(), sampled_keys.begin(), sampled_keys.end());
  CsvTable table(columns);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<CsvTable::Cell> cells;
    for (const std::string& key : row_keys) cells.push_back(cell_of(rows[i], key));
    for (const std::string& key : sampled_keys) cells.push_back(cell_of(sampled[i], key));
    table.add(cells);
  }
  return table;
}

}  // namespace

void write_manifest(const SweepConfig& sweep, const SweepPlan& plan, const fs::path& folder) {
  Json manifest;
  manifest["format_version"] = 1;
  manifest["title"] = sweep.title;
  manifest["tool_version"] = version();
  manifest["commit"] = git_commit();
  manifest["sweep_sha256"] = sha256_of_file(folder / "sweep.yaml");
  manifest["seed"] = sweep.generate->seed;
  manifest["classes"] = sweep.generate->classes;
  manifest["scenes"] = scene_rows(*sweep.generate);
  manifest["datasets"] = Json::array();
  for (std::size_t i = 0; i < plan.simulations.size(); ++i)
    manifest["datasets"].push_back(
        manifest_row(generated_dataset(*sweep.generate, sweep.generate->first + i),
                     plan.simulations[i], folder));
  write_splits(manifest["datasets"], folder);
  write_atomically(folder / "manifest.json",
                   manifest.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  manifest_csv(manifest["datasets"]).save(folder / "manifest.csv");
  write_dataset_card(manifest, folder);
}

}  // namespace saccade
