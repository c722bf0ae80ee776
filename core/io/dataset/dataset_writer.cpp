#include "core/io/dataset/dataset_writer.h"

#include <fmt/format.h>

#include <array>

#include "core/check.h"
#include "core/error.h"
#include "core/io/images/exr_file.h"
#include "core/io/images/image_file.h"
#include "core/io/imu_file.h"
#include "core/io/trajectory_file.h"
#include "core/version.h"

namespace saccade {
namespace fs = std::filesystem;
namespace {

/// Three planes as one picture.
template <class Pixel, class Planes>
Image<Pixel> interleaved(const Planes& planes) {
  Image<Pixel> image(planes[0].width(), planes[0].height());
  for (std::size_t i = 0; i < image.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) image.pixels()[i][c] = planes[c].pixels()[i];
  return image;
}

/// "depth/depth_00000012.exr".
fs::path numbered(const char* folder, const char* stem, std::size_t index, const char* ending) {
  return fs::path(folder) / fmt::format("{}_{:08}.{}", stem, index, ending);
}

/// The folder may have been taken away meanwhile, and made anew by the next file.
void check_present(const fs::path& folder, const std::vector<StampedFile>& list) {
  for (const StampedFile& listed : list)
    if (!fs::exists(folder / listed.file))
      throw InputError((folder / listed.file).string(), "was removed by someone else");
}

void write_list_if_any(const fs::path& list, const std::vector<StampedFile>& files) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    SACCADE_CHECK(!files[i].file.empty());  // no index was left out
    SACCADE_CHECK(i == 0 || files[i - 1].t_s < files[i].t_s);
  }
  if (!files.empty()) write_file_list(list, files);
}

/// False when `file` is not there, cannot be read, or does not please `check`.
template <class Check>
bool decodes(const fs::path& file, const Check& check) {
  if (!fs::exists(file)) return false;
  try {
    return check();
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

DatasetWriter::DatasetWriter(const fs::path& folder, const PinholeCamera& camera,
                             const DatasetWriterOptions& options)
    : folder_(folder), camera_(camera), options_(options) {
  const SensorSize sensor{camera.width, camera.height};
  event_writers_.push_back(
      make_event_writer(folder_ / "events.h5", options.timestamp_unit, sensor));
  if (options.events_text)
    event_writers_.push_back(make_event_writer(folder_ / "events.txt", options.timestamp_unit));
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
  list[index] = {t_s, folder_ / file};
}

void DatasetWriter::write_frame(std::size_t index, double t_s, const ImageF& radiance) {
  const std::span<const ImageF> plane(&radiance, 1);
  write_frame(index, t_s, plane, plane);
}

void DatasetWriter::write_frame(std::size_t index, double t_s, std::span<const ImageF> exposed,
                                std::span<const ImageF> radiance) {
  const fs::path png = numbered("images", "frame", index, "png");
  const fs::path exr = numbered("images", "frame", index, "exr");
  SACCADE_CHECK(exposed.size() == radiance.size());
  if (exposed.size() == 1) {
    write_png(folder_ / png, codes_from_linear(exposed[0], options_.tone));
    write_exr(folder_ / exr, radiance[0], "Y");
  } else {
    SACCADE_CHECK(exposed.size() == 3);
    std::array<ImageU8, 3> codes;
    for (std::size_t c = 0; c < 3; ++c) codes[c] = codes_from_linear(exposed[c], options_.tone);
    write_png(folder_ / png, interleaved<Rgb8>(codes));
    write_exr(folder_ / exr, interleaved<RgbF>(radiance));
  }
  store(frames_, index, t_s, png);
}

void DatasetWriter::write_depth(std::size_t index, double t_s, const ImageF& depth) {
  const fs::path file = numbered("depth", "depth", index, "exr");
  write_exr(folder_ / file, depth, "Z");
  store(depth_maps_, index, t_s, file);
  store_depths(index, depth);
}

void DatasetWriter::store_depths(std::size_t index, const ImageF& depth) {
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
  write_exr_flow(folder_ / file, flow);
  store(flow_maps_, index, t_s, file);
}

bool DatasetWriter::has_size(const ImageF& image) const {
  return image.width() == camera_.width && image.height() == camera_.height;
}

bool DatasetWriter::take_up_frame(std::size_t index, double t_s) {
  const fs::path png = numbered("images", "frame", index, "png");
  const fs::path exr = numbered("images", "frame", index, "exr");
  const bool complete = decodes(folder_ / exr, [&] { return has_size(read_exr(folder_ / exr)); }) &&
                        decodes(folder_ / png, [&] {
                          return read_image_grey(folder_ / png).size() ==
                                 static_cast<std::size_t>(camera_.width * camera_.height);
                        });
  if (complete) store(frames_, index, t_s, png);
  return complete;
}

bool DatasetWriter::take_up_depth(std::size_t index, double t_s) {
  const fs::path file = numbered("depth", "depth", index, "exr");
  ImageF depth;
  const bool complete = decodes(folder_ / file, [&] {
    depth = read_exr(folder_ / file);
    return has_size(depth);
  });
  if (!complete) return false;
  store(depth_maps_, index, t_s, file);
  store_depths(index, depth);
  return true;
}

bool DatasetWriter::take_up_flow(std::size_t index, double t_s) {
  const fs::path file = numbered("flow", "flow", index, "exr");
  const bool complete =
      decodes(folder_ / file, [&] { return has_size(read_exr_flow(folder_ / file).u); });
  if (complete) store(flow_maps_, index, t_s, file);
  return complete;
}

void DatasetWriter::write_groundtruth(std::span<const StampedPose> world_from_camera) {
  write_tum_trajectory(folder_ / "groundtruth.txt", world_from_camera);
}

void DatasetWriter::write_imu(std::span<const ImuSample> samples) {
  saccade::write_imu(folder_ / "imu.txt", samples);
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
  for (const auto* list : {&frames_, &depth_maps_, &flow_maps_}) check_present(folder_, *list);
  write_list_if_any(folder_ / "images.txt", frames_);
  write_list_if_any(folder_ / "depth.txt", depth_maps_);
  write_list_if_any(folder_ / "flow.txt", flow_maps_);
  write_calib_txt(folder_ / "calib.txt", camera_);
  const std::vector<ChainCamera> alone = {{.camera = camera_}};
  write_camera_chain(folder_ / "camera.yaml", options_.chain.empty() ? alone : options_.chain);
  counts_.frames = static_cast<std::int64_t>(frames_.size());
  counts_.depth_maps = static_cast<std::int64_t>(depth_maps_.size());
  counts_.flow_maps = static_cast<std::int64_t>(flow_maps_.size());
  if (record.counts) {
    counts_.masks = record.counts->masks;
    counts_.normal_maps = record.counts->normal_maps;
    counts_.optical_flows = record.counts->optical_flows;
  }
  record.format_version = 1;
  if (record.name.empty()) record.name = folder_.filename().string();
  record.tool_version = fmt::format("saccade {} ({})", version(), git_commit());
  record.width = camera_.width;
  record.height = camera_.height;
  record.timestamp_unit = options_.timestamp_unit == TimestampUnit::kMicroseconds ? "us" : "ns";
  record.counts = counts_;
  if (const std::optional<double> mean = mean_depth()) record.mean_scene_depth_m = mean;
  const std::int64_t events = counts_.events_on + counts_.events_off;
  if (record.rays && events > 0)
    record.rays_per_event = static_cast<double>(*record.rays) / static_cast<double>(events);
  record.sha256 = hash_files(folder_);
  write_dataset_record(folder_ / "dataset.yaml", record);
  return record;
}

}  // namespace saccade
