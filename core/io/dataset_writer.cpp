#include "core/io/dataset_writer.h"

#include <fmt/format.h>

#include "core/check.h"
#include "core/error.h"
#include "core/io/calibration_file.h"
#include "core/io/image_file.h"
#include "core/io/imu_file.h"
#include "core/io/trajectory_file.h"
#include "core/srgb.h"
#include "core/version.h"

namespace saccade {
namespace fs = std::filesystem;
namespace {

/// "depth/depth_00000012.exr".
fs::path numbered(const char* folder, const char* stem, std::size_t index, const char* ending) {
  return fs::path(folder) / fmt::format("{}_{:08}.{}", stem, index, ending);
}

void write_list_if_any(const fs::path& list, const std::vector<StampedFile>& files) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    SACCADE_CHECK(!files[i].file.empty());  // no index was left out
    SACCADE_CHECK(i == 0 || files[i - 1].t_s < files[i].t_s);
  }
  if (!files.empty()) write_file_list(list, files);
}

}  // namespace

DatasetWriter::DatasetWriter(const fs::path& folder, const PinholeCamera& camera,
                             const DatasetWriterOptions& options)
    : target_(folder, "dataset.yaml"), camera_(camera), options_(options) {
  event_writers_.push_back(make_event_writer(target_.path() / "events.h5", options.timestamp_unit));
  if (options.events_text)
    event_writers_.push_back(
        make_event_writer(target_.path() / "events.txt", options.timestamp_unit));
}

DatasetWriter::~DatasetWriter() = default;

void DatasetWriter::write_events(std::span<const Event> events) {
  for (const std::unique_ptr<EventWriter>& writer : event_writers_) writer->append(events);
  for (const Event& event : events) ++(event.polarity > 0 ? counts_.events_on : counts_.events_off);
}

void DatasetWriter::store(std::vector<StampedFile>& list, std::size_t index, double t_s,
                          const fs::path& file) {
  const std::scoped_lock lock(mutex_);
  if (list.size() <= index) list.resize(index + 1);
  list[index] = {t_s, target_.path() / file};
}

void DatasetWriter::write_frame(std::size_t index, double t_s, const ImageF& radiance) {
  const fs::path png = numbered("images", "frame", index, "png");
  write_png(target_.path() / png, srgb8_from_linear(radiance));
  write_exr(target_.path() / numbered("images", "frame", index, "exr"), radiance, "Y");
  store(frames_, index, t_s, png);
}

void DatasetWriter::write_depth(std::size_t index, double t_s, const ImageF& depth) {
  const fs::path file = numbered("depth", "depth", index, "exr");
  write_exr(target_.path() / file, depth, "Z");
  store(depth_maps_, index, t_s, file);
  Depths depths;
  for (const float z : depth.pixels())
    if (z > 0) {
      depths.sum += static_cast<double>(z);
      ++depths.count;
    }
  const std::scoped_lock lock(mutex_);
  if (depths_.size() <= index) depths_.resize(index + 1);
  depths_[index] = depths;
}

void DatasetWriter::write_flow(std::size_t index, double t_s, const FlowField& flow) {
  const fs::path file = numbered("flow", "flow", index, "exr");
  write_exr_flow(target_.path() / file, flow);
  store(flow_maps_, index, t_s, file);
}

void DatasetWriter::write_groundtruth(std::span<const StampedPose> world_from_camera) {
  write_tum_trajectory(target_.path() / "groundtruth.txt", world_from_camera);
}

void DatasetWriter::write_imu(std::span<const ImuSample> samples) {
  saccade::write_imu(target_.path() / "imu.txt", samples);
  counts_.imu_samples = static_cast<std::int64_t>(samples.size());
}

std::optional<double> DatasetWriter::mean_depth() const {
  Depths all;
  for (const Depths& depths : depths_) {
    all.sum += depths.sum;
    all.count += depths.count;
  }
  if (all.count == 0) return std::nullopt;
  return all.sum / static_cast<double>(all.count);
}

DatasetRecord DatasetWriter::finish(DatasetRecord record) {
  for (const std::unique_ptr<EventWriter>& writer : event_writers_) writer->close();
  const fs::path& folder = target_.path();
  write_list_if_any(folder / "images.txt", frames_);
  write_list_if_any(folder / "depth.txt", depth_maps_);
  write_list_if_any(folder / "flow.txt", flow_maps_);
  write_calib_txt(folder / "calib.txt", camera_);
  write_camera_yaml(folder / "camera.yaml", camera_);
  counts_.frames = static_cast<std::int64_t>(frames_.size());
  counts_.depth_maps = static_cast<std::int64_t>(depth_maps_.size());
  counts_.flow_maps = static_cast<std::int64_t>(flow_maps_.size());
  record.format_version = 1;
  if (record.name.empty()) record.name = target_.target().filename().string();
  record.tool_version = fmt::format("saccade {} ({})", version(), git_commit());
  record.width = camera_.width;
  record.height = camera_.height;
  record.timestamp_unit = options_.timestamp_unit == TimestampUnit::kMicroseconds ? "us" : "ns";
  record.counts = counts_;
  if (const std::optional<double> mean = mean_depth()) record.mean_scene_depth_m = mean;
  const std::int64_t events = counts_.events_on + counts_.events_off;
  if (record.rays && events > 0)
    record.rays_per_event = static_cast<double>(*record.rays) / static_cast<double>(events);
  record.sha256 = hash_files(folder);
  write_dataset_record(folder / "dataset.yaml", record);
  target_.commit();
  return record;
}

}  // namespace saccade
