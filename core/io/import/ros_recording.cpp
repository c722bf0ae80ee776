#include "core/io/import/ros_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "core/error.h"
#include "core/io/dataset/dataset_writer.h"
#include "core/io/events/event_formats.h"
#include "core/io/files/atomic_file.h"
#include "core/io/import/camera_files.h"
#include "core/io/import/ros_messages.h"
#include "core/io/ros/message_events.h"
#include "core/io/ros/message_file.h"
#include "core/process/progress.h"
#include "core/srgb.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// What a topic is to a dataset.
enum class TopicUse { kEvents, kImu, kFrames, kDepth, kPoses, kCamera };

constexpr std::string_view kImu = "sensor_msgs/Imu";
constexpr std::string_view kImage = "sensor_msgs/Image";
constexpr std::string_view kCameraInfo = "sensor_msgs/CameraInfo";

std::size_t common_letters(std::string_view a, std::string_view b) {
  const auto [end, other] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  return static_cast<std::size_t>(end - a.begin());
}

/// Of the topics of each use that one which goes with that of the events, and the camera.
struct RosContents {
  std::map<TopicUse, std::string> topics;
  std::optional<PinholeCamera> camera;

  [[nodiscard]] bool is_chosen(TopicUse use, const std::string& topic) const {
    const auto chosen = topics.find(use);
    return chosen != topics.end() && chosen->second == topic;
  }
};

/// One pass over the recording that finds out what its topics hold.
class RosSurvey {
 public:
  RosSurvey(const EventFilePlace& place, SensorSize sensor)
      : file_(open_message_file(place.file)), event_topic_(place.member), sensor_(sensor) {}

  RosContents run() {
    while (const auto message = file_->next()) look_at(*message);
    for (const MessageTopic* topic : file_->topics())
      if (event_topic_.empty() && holds_events(*topic)) event_topic_ = topic->name;
    RosContents contents;
    for (const auto& [use, topics] : candidates_) contents.topics[use] = nearest(topics);
    const auto chosen = contents.topics.find(TopicUse::kCamera);
    if (chosen == contents.topics.end()) return contents;
    const Camera& camera = cameras_.at(chosen->second);
    // Where its lens cannot be read, only a calibration that is named helps.
    problem_ = camera.problem;
    contents.camera = camera.camera;
    return contents;
  }

  /// Why the camera that goes with the events could not be read; empty: it was, or there is none.
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  struct Camera {
    std::optional<PinholeCamera> camera;
    std::string problem;
  };

  void look_at(const Message& message) {
    const MessageTopic& topic = *message.topic;
    if (topic.serialisation == Serialisation::kOther || !seen_.insert(topic.name).second) return;
    if (topic.type == kImu) candidates_[TopicUse::kImu].insert(topic.name);
    if (holds_poses(topic)) candidates_[TopicUse::kPoses].insert(topic.name);
    if (topic.type == kImage) look_at_image(message);
    if (topic.type == kCameraInfo) look_at_camera(message);
  }

  void look_at_image(const Message& message) {
    const std::string& topic = message.topic->name;
    MessageReader reader(*file_, message);
    const ImageMessage image = read_image_message(reader);
    const bool is_other_size =
        sensor_.width > 0 && (image.width != static_cast<std::uint32_t>(sensor_.width) ||
                              image.height != static_cast<std::uint32_t>(sensor_.height));
    if (image.kind() == ImageMessage::Kind::kOther)
      show_notice(
          fmt::format("{} is skipped: pictures of the encoding '{}' cannot be read; mono8, "
                      "8UC1, rgb8, bgr8, 32FC1 and 16UC1 can",
                      topic, image.encoding));
    else if (is_other_size)
      show_notice(
          fmt::format("{} is skipped: its pictures of {} x {} px are of another camera than "
                      "the events, of {} x {} px",
                      topic, image.width, image.height, sensor_.width, sensor_.height));
    else
      candidates_[image.is_picture() ? TopicUse::kFrames : TopicUse::kDepth].insert(topic);
  }

  void look_at_camera(const Message& message) {
    const std::string& topic = message.topic->name;
    Camera camera;
    try {
      MessageReader reader(*file_, message);
      camera.camera = read_camera_message(reader);
      if (!camera.camera) {
        seen_.erase(topic);  // a later message may be calibrated
        return;
      }
    } catch (const InputError& error) {
      camera.problem = error.what();
    }
    candidates_[TopicUse::kCamera].insert(topic);
    cameras_.insert_or_assign(topic, camera);
  }

  /// The names are in order: of equally near ones the first counts.
  [[nodiscard]] std::string nearest(const std::set<std::string>& topics) const {
    return *std::max_element(
        topics.begin(), topics.end(), [&](const std::string& a, const std::string& b) {
          return common_letters(a, event_topic_) < common_letters(b, event_topic_);
        });
  }

  std::unique_ptr<MessageFile> file_;
  std::string event_topic_;
  SensorSize sensor_;
  std::set<std::string> seen_;
  std::map<TopicUse, std::set<std::string>> candidates_;
  std::map<std::string, Camera> cameras_;
  std::string problem_;
};

ChainCamera camera_of(const EventFilePlace& place, const RosSurvey& survey,
                      const RosContents& contents, const fs::path& calibration, SensorSize sensor) {
  if (!calibration.empty()) return read_any_calibration(calibration, sensor);
  if (contents.camera) return {.camera = *contents.camera};
  if (const auto found = find_calibration({}, place.file.parent_path(), sensor)) return *found;
  if (!survey.problem().empty()) throw InputError("", survey.problem());
  throw InputError(place.file.string(),
                   "holds no calibrated sensor_msgs/CameraInfo; name a calibration with "
                   "--calibration, or write the line \"fx fy cx cy k1 k2 p1 p2 k3\" into a file "
                   "calib.txt beside it");
}

/// Everything but the events, in one pass.
class RosCopy {
 public:
  RosCopy(MessageFile& file, const RosContents& contents, TimeWindow times, double timeshift_s,
          DatasetWriter& writer)
      : file_(file),
        contents_(contents),
        times_(times),
        timeshift_ns_(ns_from_seconds(timeshift_s)),
        writer_(writer) {}

  ImportCounts run() {
    while (const auto message = file_.next()) copy(*message);
    if (!poses_.empty()) writer_.write_groundtruth(poses_);
    if (!imu_.empty()) writer_.write_imu(imu_);
    counts_.imu_samples = imu_.size();
    counts_.poses = poses_.size();
    return counts_;
  }

 private:
  void copy(const Message& message) {
    const MessageTopic& topic = *message.topic;
    if (contents_.is_chosen(TopicUse::kImu, topic.name)) return copy_imu(message);
    if (contents_.is_chosen(TopicUse::kPoses, topic.name)) return copy_pose(message);
    const bool is_frame = contents_.is_chosen(TopicUse::kFrames, topic.name);
    if (is_frame || contents_.is_chosen(TopicUse::kDepth, topic.name))
      copy_image(message, is_frame);
  }

  void copy_imu(const Message& message) {
    MessageReader reader(file_, message);
    ImuSample sample = read_imu_message(reader);
    sample.t_ns -= timeshift_ns_;
    // A sample that a driver delivers twice, or late, counts once.
    if (contains(sample.t_ns) && (imu_.empty() || sample.t_ns > imu_.back().t_ns))
      imu_.push_back(sample);
  }

  void copy_pose(const Message& message) {
    MessageReader reader(file_, message);
    const StampedPose pose = read_pose_message(*message.topic, reader);
    if (contains(ns_from_seconds(pose.t_s)) && (poses_.empty() || pose.t_s > poses_.back().t_s))
      poses_.push_back(pose);
  }

  void copy_image(const Message& message, bool is_frame) {
    MessageReader reader(file_, message);
    const ImageMessage image = read_image_message(reader);
    TimeNs& last_ns = is_frame ? last_frame_ns_ : last_depth_ns_;
    if (!contains(image.t_ns) || image.t_ns <= last_ns) return;
    if (is_frame ? !image.is_picture() : image.kind() != ImageMessage::Kind::kDepth)
      reader.fail(fmt::format("its encoding changes to '{}'", image.encoding));
    last_ns = image.t_ns;
    if (is_frame)
      writer_.write_frame(counts_.frames++, seconds_from_ns(image.t_ns),
                          linear_from_srgb8(grey_of(image)));
    else
      writer_.write_depth(counts_.depth_maps++, seconds_from_ns(image.t_ns), depth_of(image));
  }

  [[nodiscard]] bool contains(TimeNs t_ns) const {
    return t_ns >= times_.start_ns && t_ns < times_.end_ns;
  }

  MessageFile& file_;
  const RosContents& contents_;
  TimeWindow times_;
  TimeNs timeshift_ns_;
  DatasetWriter& writer_;
  std::vector<ImuSample> imu_;
  std::vector<StampedPose> poses_;
  TimeNs last_frame_ns_ = TimeWindow().start_ns;
  TimeNs last_depth_ns_ = TimeWindow().start_ns;
  ImportCounts counts_;
};

/// The part of the recording that is asked for; from the first event on.
TimeWindow ros_times(const fs::path& path, const ImportWindow& window) {
  EventStream stream(path);
  const std::span<const Event> first = stream.next();
  if (first.empty()) throw InputError(path.string(), "holds no events");
  TimeWindow times;
  times.start_ns = first.front().t_ns + ns_from_seconds(window.start_s);
  if (window.duration_s) times.end_ns = times.start_ns + ns_from_seconds(*window.duration_s);
  return times;
}

}  // namespace

bool is_ros_recording(const fs::path& path) {
  const fs::path file = event_file_place(path).file;
  return is_message_file(file);
}

ImportCounts write_ros_recording(const fs::path& path, const fs::path& folder,
                                 const ImportWindow& window, const fs::path& calibration) {
  const EventFilePlace place = event_file_place(path);
  const TimeWindow times = ros_times(path, window);
  const SensorSize sensor = stated_sensor(path);
  RosSurvey survey(place, sensor);
  const RosContents contents = survey.run();
  const ChainCamera chained = camera_of(place, survey, contents, calibration, sensor);
  const PinholeCamera& camera = chained.camera;
  AtomicFolder output(folder, "dataset.yaml");
  DatasetWriterOptions options;
  options.timestamp_unit = TimestampUnit::kNanoseconds;
  options.chain = {chained};
  DatasetWriter writer(output.path(), camera, options);
  const std::unique_ptr<MessageFile> file = open_message_file(place.file);
  // Without a start, what comes before the first event belongs to it as well.
  TimeWindow others = times;
  if (window.start_s == 0) others.start_ns = TimeWindow().start_ns;
  ImportCounts counts = RosCopy(*file, contents, others, chained.timeshift_s, writer).run();
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
