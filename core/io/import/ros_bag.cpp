#include "core/io/import/ros_bag.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>

#include "core/error.h"
#include "core/io/calibration_file.h"
#include "core/io/dataset/dataset_writer.h"
#include "core/io/events/event_formats.h"
#include "core/io/files/atomic_file.h"
#include "core/io/import/ros_messages.h"
#include "core/io/ros/bag_events.h"
#include "core/io/ros/bag_file.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kImu = "sensor_msgs/Imu";
constexpr std::string_view kImage = "sensor_msgs/Image";
constexpr std::string_view kPose = "geometry_msgs/PoseStamped";
constexpr std::string_view kCameraInfo = "sensor_msgs/CameraInfo";

std::size_t common_letters(std::string_view a, std::string_view b) {
  const auto [end, other] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  return static_cast<std::size_t>(end - a.begin());
}

/// The topic of each type that goes with that of the events, and the camera.
struct BagContents {
  std::map<std::string, std::string, std::less<>> topic_of_type;
  std::optional<PinholeCamera> camera;
};

BagContents survey(const fs::path& file, const std::string& event_topic) {
  std::map<std::string, PinholeCamera, std::less<>> cameras;
  BagFile bag(file);
  while (const auto message = bag.next()) {
    if (message->topic->type != kCameraInfo || cameras.contains(message->topic->name)) continue;
    BagMessageReader reader(bag.bytes(), *message);
    if (const auto camera = read_camera_message(reader))
      cameras.emplace(message->topic->name, *camera);
  }
  BagContents contents;
  // Of a bag with one topic of events nobody names it.
  std::string beside = event_topic;
  for (const auto& [number, topic] : bag.topics())
    if (beside.empty() && holds_events(topic)) beside = topic.name;
  for (const auto& [number, topic] : bag.topics()) {
    std::string& chosen = contents.topic_of_type[topic.type];
    const std::size_t common = common_letters(topic.name, beside);
    const std::size_t before = common_letters(chosen, beside);
    if (chosen.empty() || common > before || (common == before && topic.name < chosen))
      chosen = topic.name;
  }
  if (const auto camera = cameras.find(contents.topic_of_type[std::string(kCameraInfo)]);
      camera != cameras.end())
    contents.camera = camera->second;
  return contents;
}

PinholeCamera camera_of(const fs::path& file, const BagContents& contents, SensorSize events) {
  if (contents.camera) return *contents.camera;
  const fs::path calibration = file.parent_path() / "calib.txt";
  if (!fs::exists(calibration))
    throw InputError(file.string(),
                     "holds no calibrated sensor_msgs/CameraInfo; write the line \"fx fy cx cy k1 "
                     "k2 p1 p2 k3\" into a file calib.txt beside it");
  PinholeCamera camera = read_calib_txt(calibration);
  camera.width = events.width;
  camera.height = events.height;
  camera.check(calibration.string());
  return camera;
}

/// Everything but the events, in one pass.
class BagCopy {
 public:
  BagCopy(BagFile& bag, const BagContents& contents, TimeWindow times, DatasetWriter& writer)
      : bag_(bag), contents_(contents), times_(times), writer_(writer) {}

  BagCounts run() {
    while (const auto message = bag_.next()) {
      const auto chosen = contents_.topic_of_type.find(message->topic->type);
      if (chosen != contents_.topic_of_type.end() && chosen->second == message->topic->name)
        copy(*message);
    }
    if (!poses_.empty()) writer_.write_groundtruth(poses_);
    if (!imu_.empty()) writer_.write_imu(imu_);
    return {.frames = frames_, .imu_samples = imu_.size(), .poses = poses_.size()};
  }

 private:
  void copy(const BagMessage& message) {
    BagMessageReader reader(bag_.bytes(), message);
    if (message.topic->type == kImu) {
      const ImuSample sample = read_imu_message(reader);
      // A sample that a driver delivers twice, or late, counts once.
      if (contains(sample.t_ns) && (imu_.empty() || sample.t_ns > imu_.back().t_ns))
        imu_.push_back(sample);
    } else if (message.topic->type == kPose) {
      const StampedPose pose = read_pose_message(reader);
      if (contains(ns_from_seconds(pose.t_s)) && (poses_.empty() || pose.t_s > poses_.back().t_s))
        poses_.push_back(pose);
    } else if (message.topic->type == kImage) {
      const StampedPicture picture = read_image_message(reader);
      if (contains(picture.t_ns))
        writer_.write_frame(frames_++, seconds_from_ns(picture.t_ns),
                            linear_from_srgb8(picture.grey));
    }
  }

  [[nodiscard]] bool contains(TimeNs t_ns) const {
    return t_ns >= times_.start_ns && t_ns < times_.end_ns;
  }

  BagFile& bag_;
  const BagContents& contents_;
  TimeWindow times_;
  DatasetWriter& writer_;
  std::vector<ImuSample> imu_;
  std::vector<StampedPose> poses_;
  std::size_t frames_ = 0;
};

/// The part of the bag that is asked for; from the first event on.
TimeWindow times_of(const fs::path& path, const ImportWindow& window) {
  EventStream stream(path);
  const std::span<const Event> first = stream.next();
  if (first.empty()) throw InputError(path.string(), "holds no events");
  TimeWindow times;
  times.start_ns = first.front().t_ns + ns_from_seconds(window.start_s);
  if (window.duration_s) times.end_ns = times.start_ns + ns_from_seconds(*window.duration_s);
  return times;
}

}  // namespace

bool is_bag(const fs::path& path) {
  const fs::path file = event_file_place(path).file;
  return fs::is_regular_file(file) && recognise_event_format(file).open == open_bag_events;
}

BagCounts write_bag_as_dataset(const fs::path& path, const fs::path& folder,
                               const ImportWindow& window) {
  const EventFilePlace place = event_file_place(path);
  const TimeWindow times = times_of(path, window);
  const BagContents contents = survey(place.file, place.member);
  const PinholeCamera camera = camera_of(place.file, contents, stated_sensor(path));
  AtomicFolder output(folder, "dataset.yaml");
  DatasetWriterOptions options;
  options.timestamp_unit = TimestampUnit::kNanoseconds;
  DatasetWriter writer(output.path(), camera, options);
  BagFile bag(place.file);
  BagCounts counts = BagCopy(bag, contents, times, writer).run();
  EventStream stream(path, {camera.width, camera.height}, times);
  TimeNs last_ns = times.start_ns;
  for (auto events = stream.next(); !events.empty(); events = stream.next()) {
    writer.write_events(events);
    counts.events += events.size();
    last_ns = events.back().t_ns;
  }
  DatasetRecord record;
  record.name = FinalFolder(folder, "dataset.yaml").path().filename().string();
  record.duration_s = seconds_from_ns(last_ns - times.start_ns);
  static_cast<void>(writer.finish(record));
  output.commit();
  return counts;
}

}  // namespace saccade
