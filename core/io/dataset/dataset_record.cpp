#include "core/io/dataset/dataset_record.h"

#include <algorithm>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/files/sha256.h"
#include "core/process/parallel.h"

namespace saccade {
namespace fs = std::filesystem;
namespace {

constexpr const char* kRecordFile = "dataset.yaml";

/// Relative paths of all files below `folder` but its record, in order.
std::vector<std::string> files_below(const fs::path& folder) {
  std::vector<std::string> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files.push_back(entry.path().lexically_relative(folder).generic_string());
  std::erase(files, kRecordFile);
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

void describe(config::Fields& fields, DatasetRecord::Counts& counts) {
  fields.value("events_on", counts.events_on, "brighter").at_least(0);
  fields.value("events_off", counts.events_off, "darker").at_least(0);
  fields.value("frames", counts.frames, "grey frames").at_least(0);
  fields.value("depth_maps", counts.depth_maps, "depth maps").at_least(0);
  fields.value("flow_maps", counts.flow_maps, "motion fields").at_least(0);
  fields.value("imu_samples", counts.imu_samples, "inertial readings").at_least(0);
  fields.value("masks", counts.masks, "masks of instances").at_least(0);
  fields.value("normal_maps", counts.normal_maps, "maps of normals").at_least(0);
  fields.value("optical_flows", counts.optical_flows, "intervals with optical flow").at_least(0);
}

void describe(config::Fields& fields, DatasetRecord::Figure& figure) {
  fields.value("value", figure.value, "measured").at_least(0);
  fields.value("low", figure.low, "of the 95 % interval").at_least(0);
  fields.value("high", figure.high, "of the 95 % interval").at_least(0);
}

void describe(config::Fields& fields, DatasetRecord::Audit& audit) {
  fields.value("reference", audit.reference, "of the comparison: exact events, or densely sampled")
      .one_of({"exact", "dense"});
  fields.value("pixels", audit.pixels, "recorded with the reference, too").at_least(0);
  fields.value("events", audit.events, "of the reference in these pixels").at_least(0);
  fields.section("precision_10us", audit.precision_10us, "events with an exact one within 10 us");
  fields.section("recall_10us", audit.recall_10us, "exact events that were found within 10 us");
  fields.section("precision_1us", audit.precision_1us, "the same within 1 us");
  fields.section("recall_1us", audit.recall_1us, "the same within 1 us");
  fields.section("p99_dt_us", audit.p99_dt_us, "99th percentile of the time error [us]");
}

void describe(config::Fields& fields, DatasetRecord& record) {
  fields.value("format_version", record.format_version, "of this file").required().range(1, 1);
  fields.value("name", record.name, "scene");
  fields.value("tool_version", record.tool_version, "program that wrote the dataset");
  fields.value("width", record.width, "sensor width [px]").required().range(1, 65535);
  fields.value("height", record.height, "sensor height [px]").required().range(1, 65535);
  fields.value("seed", record.seed, "of all random numbers");
  fields.value("timestamp_unit", record.timestamp_unit, "of events.h5").one_of({"us", "ns"});
  fields.value("duration_s", record.duration_s, "[s]").at_least(0);
  fields.section("counts", record.counts, "what the folder holds");
  fields.value("mean_scene_depth_m", record.mean_scene_depth_m, "mean z over all depth maps [m]")
      .above(0);
  fields.value("contrast_on", record.contrast_on, "threshold [log units]").above(0);
  fields.value("contrast_off", record.contrast_off, "threshold [log units]").above(0);
  fields.value("log_eps", record.log_eps, "eps of L = ln(eps + I)").above(0);
  fields.value("rays", record.rays, "for visibility, in all").at_least(0);
  fields.value("lit_points", record.lit_points, "whose light was found").at_least(0);
  fields.value("surface_looks", record.surface_samples, "samples of known triangles, without a ray")
      .at_least(0);
  fields.value("lost_events", record.lost_events, "that met a full readout").at_least(0);
  fields.value("rays_per_event", record.rays_per_event, "[-]").at_least(0);
  fields
      .value("time_bound_us", record.time_bound_us,
             "of every event's time, before rounding to the unit [us]")
      .at_least(0);
  fields.value("path_length_m", record.path_length_m, "of the camera [m]").at_least(0);
  fields.value("sampling", record.sampling, "of the events")
      .one_of({"exact", "adaptive", "frames"});
  fields.value("sampling_reason", record.sampling_reason, "where it was chosen automatically");
  fields.section("audit", record.audit, "of sampled events against exact ones");
  fields.embed("config", record.config_yaml, "the resolved configuration");
  fields.value("sha256", record.sha256, "of every other file");
}

DatasetRecord read_dataset_record(const fs::path& file) {
  return config::read<DatasetRecord>(config::load(file));
}

void write_dataset_record(const fs::path& file, const DatasetRecord& record) {
  write_atomically(file, config::print(record));
}

std::map<std::string, std::string> hash_files(const fs::path& folder) {
  const std::vector<std::string> files = files_below(folder);
  std::vector<std::string> hashes(files.size());
  parallel_for(files.size(), [&](std::size_t i) { hashes[i] = sha256_of_file(folder / files[i]); });
  std::map<std::string, std::string> result;
  for (std::size_t i = 0; i < files.size(); ++i) result.emplace(files[i], std::move(hashes[i]));
  return result;
}

std::vector<std::string> verify_hashes(const fs::path& folder) {
  const fs::path file = folder / kRecordFile;
  const DatasetRecord record = read_dataset_record(file);
  if (record.sha256.empty()) throw InputError(file.string(), "states no sha256 to verify");
  const std::map<std::string, std::string> found = hash_files(folder);
  std::vector<std::string> problems;
  for (const auto& [name, hash] : record.sha256) {
    const auto it = found.find(name);
    if (it == found.end()) problems.push_back(name + ": missing");
    if (it != found.end() && it->second != hash) problems.push_back(name + ": changed");
  }
  for (const auto& [name, hash] : found)
    if (!record.sha256.contains(name)) problems.push_back(name + ": not listed in dataset.yaml");
  return problems;
}

}  // namespace saccade
