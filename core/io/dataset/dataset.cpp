#include "core/io/dataset/dataset.h"

#include <cmath>

#include "core/check.h"
#include "core/error.h"
#include "core/io/calibration_file.h"
#include "core/io/events/event_formats.h"
#include "core/io/events/events_h5.h"
#include "core/io/images/image_file.h"
#include "core/io/imu_file.h"
#include "core/io/trajectory_file.h"
#include "core/srgb.h"

namespace saccade {
namespace fs = std::filesystem;
namespace {

std::vector<StampedFile> read_list_if_there(const fs::path& list) {
  return fs::exists(list) ? read_file_list(list) : std::vector<StampedFile>{};
}

bool is_exr(const fs::path& file) { return file.extension() == ".exr"; }

/// The linear picture beside an 8-bit one.
fs::path exr_of(const fs::path& file) { return fs::path(file).replace_extension(".exr"); }

ImageF read_plane(const fs::path& file) {
  if (is_exr(file)) return read_exr(file);
  if (fs::exists(exr_of(file))) return read_exr(exr_of(file));
  return linear_from_srgb8(read_image_grey(file));
}

/// Sets the size from the first picture that is there; stays 0 when none is.
void take_size_of_images(const std::vector<StampedFile>& frames, PinholeCamera& camera) {
  for (const StampedFile& frame : frames) {
    if (!fs::exists(frame.file) && !fs::exists(exr_of(frame.file))) continue;
    const ImageF image = read_plane(frame.file);
    camera.width = image.width();
    camera.height = image.height();
    return;
  }
}

fs::path find_events(const fs::path& folder) {
  for (const EventFormat& format : event_formats()) {
    fs::path file = folder / ("events" + std::string(format.ending));
    if (fs::exists(file)) return file;
  }
  return {};
}

void take_size_of_events(const fs::path& events, PinholeCamera& camera) {
  if (events.empty()) return;
  const SensorSize sensor = stated_sensor(events);
  camera.width = sensor.width;
  camera.height = sensor.height;
}

PinholeCamera read_camera(const fs::path& folder, const std::optional<DatasetRecord>& record,
                          const std::vector<StampedFile>& frames) {
  const fs::path calib = folder / "calib.txt";
  const fs::path chain = folder / "camera.yaml";
  if (!fs::exists(calib) && !fs::exists(chain))
    throw InputError(folder.string(), "has neither calib.txt nor camera.yaml");
  PinholeCamera camera;
  if (fs::exists(chain)) camera = read_camera_yaml(chain);
  if (fs::exists(calib)) {
    const PinholeCamera sized = camera;
    camera = read_calib_txt(calib);
    camera.width = sized.width;
    camera.height = sized.height;
  }
  if (record) {
    camera.width = record->width;
    camera.height = record->height;
  }
  if (camera.width == 0) take_size_of_images(frames, camera);
  if (camera.width == 0) take_size_of_events(find_events(folder), camera);
  if (camera.width == 0)
    throw InputError(
        folder.string(),
        "the sensor size is unknown: there is no picture to take it from, and the events "
        "do not state it; state it in camera.yaml (cam0: resolution) or "
        "dataset.yaml (width, height)");
  camera.check((fs::exists(calib) ? calib : chain).string());
  return camera;
}

DatasetFacts facts_of(const fs::path& folder, const std::optional<DatasetRecord>& record) {
  DatasetFacts facts;
  const fs::path whole = fs::absolute(folder).lexically_normal();
  facts.name = (whole.has_filename() ? whole : whole.parent_path()).filename().string();
  if (!record) return facts;
  facts.mean_depth_m = record->mean_scene_depth_m;
  facts.contrast_on = record->contrast_on;
  facts.contrast_off = record->contrast_off;
  facts.log_eps = record->log_eps;
  if (!record->name.empty()) facts.name = record->name;
  return facts;
}

/// Seconds -> ns; beyond +-9e9 s the end of the int64 range.
TimeNs clamped_ns(double t_s) {
  SACCADE_CHECK(!std::isnan(t_s));
  if (t_s <= -9e9) return std::numeric_limits<TimeNs>::min();
  if (t_s >= 9e9) return std::numeric_limits<TimeNs>::max();
  return ns_from_seconds(t_s);
}

void expect_size(const ImageF& image, const PinholeCamera& camera, const fs::path& file) {
  if (image.width() == camera.width && image.height() == camera.height) return;
  throw InputError(file.string(), "is " + std::to_string(image.width()) + " x " +
                                      std::to_string(image.height()) + " px, the sensor " +
                                      std::to_string(camera.width) + " x " +
                                      std::to_string(camera.height));
}

}  // namespace

Dataset Dataset::open(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    if (!fs::exists(folder)) throw InputError(folder.string(), "no such dataset folder");
    throw InputError(folder.string(),
                     folder.extension() == ".yaml"
                         ? "is a file; if it configures a simulation, saccade simulate makes a "
                           "dataset of it"
                         : "is no folder");
  }
  Dataset dataset;
  dataset.folder_ = folder;
  dataset.events_file_ = find_events(folder);
  const fs::path record_file = folder / "dataset.yaml";
  if (fs::exists(record_file)) dataset.record_ = read_dataset_record(record_file);
  if (!dataset.record_ && dataset.events_file_.empty() && !fs::exists(folder / "images.txt"))
    throw InputError(folder.string(), "is no dataset: it holds no dataset.yaml, " +
                                          event_file_names() + " or images.txt");
  dataset.frames_ = read_list_if_there(folder / "images.txt");
  dataset.depth_maps_ = read_list_if_there(folder / "depth.txt");
  dataset.flow_maps_ = read_list_if_there(folder / "flow.txt");
  dataset.camera_ = read_camera(folder, dataset.record_, dataset.frames_);
  dataset.facts_ = facts_of(folder, dataset.record_);
  const fs::path poses = folder / "groundtruth.txt";
  if (fs::exists(poses)) dataset.groundtruth_ = read_tum_trajectory(poses);
  return dataset;
}

TimeWindow time_window(double start_s, double end_s) {
  return {clamped_ns(start_s), clamped_ns(end_s)};
}

Events Dataset::load_events(double start_s, double end_s) const {
  return load_events(time_window(start_s, end_s));
}

Events Dataset::load_events(TimeWindow window) const {
  check_events();
  return read_events(events_file_, {camera_.width, camera_.height}, window);
}

EventStream Dataset::stream_events(TimeWindow window) const {
  check_events();
  return EventStream(events_file_, {camera_.width, camera_.height}, window);
}

void Dataset::check_events() const {
  if (events_file_.empty())
    throw InputError(folder_.string(), "holds no events (" + event_file_names() + ")");
}

ImageF Dataset::load_frame(std::size_t index) const {
  SACCADE_CHECK(index < frames_.size());
  const fs::path& file = frames_[index].file;
  ImageF image = read_plane(file);
  expect_size(image, camera_, file);
  for (const float radiance : image.pixels())
    if (!std::isfinite(radiance))
      throw InputError(file.string(), "holds a pixel that is no number");
  return image;
}

ImageF Dataset::load_depth(std::size_t index) const {
  SACCADE_CHECK(index < depth_maps_.size());
  const fs::path& file = depth_maps_[index].file;
  ImageF depth = read_exr(file);
  expect_size(depth, camera_, file);
  for (const float z : depth.pixels())
    if (!(z >= 0) || std::isinf(z))
      throw InputError(file.string(), "holds a depth that is negative, infinite or no number");
  return depth;
}

FlowField Dataset::load_flow(std::size_t index) const {
  SACCADE_CHECK(index < flow_maps_.size());
  FlowField flow = read_exr_flow(flow_maps_[index].file);
  expect_size(flow.u, camera_, flow_maps_[index].file);
  return flow;
}

ImageF Dataset::load_panorama() const {
  const fs::path file = folder_ / "panorama.exr";
  if (!fs::exists(file)) return {};
  ImageF image = read_exr(file);
  if (image.width() < 4 || image.width() != 2 * image.height())
    throw InputError(file.string(), "must be twice as wide as high: a whole sphere");
  return image;
}

bool Dataset::has_labels() const { return fs::exists(folder_ / "labels.h5"); }

EventLabels Dataset::load_labels(double start_s, double end_s) const {
  const fs::path events = folder_ / "events.h5";
  if (!fs::exists(events)) throw InputError(events.string(), "is missing; labels belong to it");
  const EventH5Reader reader(events);
  const auto [begin, end] = reader.range(time_window(start_s, end_s));
  return read_labels_h5(folder_ / "labels.h5", reader.info().count, begin, end);
}

std::vector<fs::path> Dataset::further_cameras() const {
  std::vector<fs::path> folders;
  while (true) {
    fs::path next = folder_ / ("cam" + std::to_string(folders.size() + 1));
    if (!fs::is_directory(next)) return folders;
    folders.push_back(std::move(next));
  }
}

bool Dataset::has_imu() const { return fs::exists(folder_ / "imu.txt"); }

std::vector<ImuSample> Dataset::load_imu() const { return read_imu(folder_ / "imu.txt"); }

std::optional<Rigid3> Dataset::camera_from_imu() const {
  const std::filesystem::path camera_chain = folder_ / "camera.yaml";
  if (!std::filesystem::exists(camera_chain)) return std::nullopt;
  return read_camera_chain(camera_chain).front().camera_from_imu;
}

std::vector<ImuTruth> Dataset::load_imu_truth() const {
  return read_imu_truth(folder_ / "imu_groundtruth.txt");
}

std::vector<StampedTwist> Dataset::load_twists() const {
  return read_twists(folder_ / "twist.txt");
}

std::vector<ObjectPose> Dataset::load_objects() const {
  const std::filesystem::path file = folder_ / "objects.txt";
  return std::filesystem::exists(file) ? read_object_poses(file) : std::vector<ObjectPose>();
}

}  // namespace saccade
