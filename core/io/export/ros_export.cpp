#include "core/io/export/ros_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/io/dataset/dataset.h"
#include "core/io/ros/event_messages.h"
#include "core/io/ros/message_writer.h"
#include "core/io/ros/written_messages.h"
#include "core/process/progress.h"
#include "core/srgb.h"

namespace saccade {
namespace {

constexpr TimeNs kPictureNs = 1'000'000'000 / 30;

/// What is written besides events, at its time.
struct ExportItem {
  enum class Kind { kPose, kImu, kFrame, kDepth };
  TimeNs t_ns;
  Kind kind;
  std::size_t index;
};

class RosExport {
 public:
  RosExport(const Dataset& dataset, const std::filesystem::path& file)
      : dataset_(dataset),
        writer_(make_message_writer(file)),
        sensor_{dataset.camera().width, dataset.camera().height},
        events_(*writer_, sensor_, file.string()) {
    if (dataset_.has_imu()) imu_ = dataset_.load_imu();
    for (std::size_t i = 0; i < imu_.size(); ++i) add(imu_[i].t_ns, ExportItem::Kind::kImu, i);
    for (std::size_t i = 0; i < dataset_.groundtruth().size(); ++i)
      add(ns_from_seconds(dataset_.groundtruth().poses()[i].t_s), ExportItem::Kind::kPose, i);
    for (std::size_t i = 0; i < dataset_.frames().size(); ++i)
      add(ns_from_seconds(dataset_.frames()[i].t_s), ExportItem::Kind::kFrame, i);
    for (std::size_t i = 0; i < dataset_.depth_maps().size(); ++i)
      add(ns_from_seconds(dataset_.depth_maps()[i].t_s), ExportItem::Kind::kDepth, i);
    std::stable_sort(items_.begin(), items_.end(),
                     [](const ExportItem& a, const ExportItem& b) { return a.t_ns < b.t_ns; });
    if (left_out_ > 0)
      show_notice(
          fmt::format("{} samples are before time 0, which ROS cannot state, and are left "
                      "out",
                      left_out_));
    add_topics();
  }

  ImportCounts run() {
    if (!dataset_.events_file().empty()) write_events();
    write_items(TimeWindow().end_ns);
    writer_->close();
    counts_.events = events_.count();
    return counts_;
  }

 private:
  [[nodiscard]] bool is_for_viewers() const {
    return writer_->serialisation() == Serialisation::kCdr;
  }

  void add(TimeNs t_ns, ExportItem::Kind kind, std::size_t index) {
    if (t_ns < 0)
      ++left_out_;
    else
      items_.push_back({t_ns, kind, index});
  }

  void add_topics() {
    info_ = writer_->add_topic("/dvs/camera_info", "sensor_msgs/CameraInfo");
    const auto add_if = [&](bool is_there, const char* name, const char* type) {
      return is_there ? writer_->add_topic(name, type) : 0U;
    };
    const bool has_depth = !dataset_.depth_maps().empty();
    const bool has_poses = !dataset_.groundtruth().empty();
    image_ = add_if(!dataset_.frames().empty(), "/dvs/image_raw", "sensor_msgs/Image");
    depth_ = add_if(has_depth, "/dvs/depth", "sensor_msgs/Image");
    pose_ = add_if(has_poses, "/dvs/pose", "geometry_msgs/PoseStamped");
    imu_topic_ = add_if(!imu_.empty(), "/dvs/imu", "sensor_msgs/Imu");
    if (!is_for_viewers()) return;
    picture_ = writer_->add_topic("/view/events", "sensor_msgs/Image");
    transform_ = add_if(has_poses, "/tf", "tf2_msgs/TFMessage");
    cloud_ = add_if(has_poses && has_depth, "/view/points", "sensor_msgs/PointCloud2");
  }

  template <class Put, class... Arguments>
  void write(unsigned topic, TimeNs t_ns, Put put, const Arguments&... arguments) {
    MessageBytes message(writer_->serialisation());
    put(arguments..., message);
    writer_->write(topic, t_ns, message.bytes());
  }

  void write_info(TimeNs t_ns) { write(info_, t_ns, put_camera_info, t_ns, dataset_.camera()); }

  void write_events() {
    EventStream stream(dataset_.events_file(), sensor_);
    Progress progress("writing", 0, "events");
    bool is_first = true;
    for (auto events = stream.next(); !events.empty(); events = stream.next()) {
      progress.add(events.size());
      if (is_first) write_info(std::max<TimeNs>(events.front().t_ns, 0));
      is_first = false;
      while (!events.empty()) {
        // The events before the next item, so that messages are in order of time.
        const TimeNs next_ns = next_ < items_.size() ? items_[next_].t_ns : TimeWindow().end_ns;
        const auto end = std::find_if(events.begin(), events.end(),
                                      [&](const Event& e) { return e.t_ns >= next_ns; });
        const auto count = static_cast<std::size_t>(end - events.begin());
        events_.append(events.first(count));
        draw(events.first(count));
        events = events.subspan(count);
        if (events.empty()) break;
        events_.flush();
        write_items(events.front().t_ns + 1);
      }
    }
    events_.flush();
    write_picture();
  }

  /// Draws the events over those since the last picture: blue for ON, red for OFF.
  void draw(std::span<const Event> events) {
    if (!is_for_viewers()) return;
    constexpr Rgb8 kPaper{255, 255, 255}, kOn{30, 90, 220}, kOff{220, 50, 40};
    for (const Event& event : events) {
      if (picture_start_ && event.t_ns - *picture_start_ >= kPictureNs) write_picture();
      if (!picture_start_) {
        picture_start_ = event.t_ns;
        canvas_ = ImageRgb8(sensor_.width, sensor_.height, kPaper);
      }
      canvas_(event.x, event.y) = event.polarity > 0 ? kOn : kOff;
    }
  }

  void write_picture() {
    if (!picture_start_) return;
    write(picture_, *picture_start_,
          [&](MessageBytes& message) { put_image(*picture_start_, canvas_, message); });
    picture_start_.reset();
  }

  void write_items(TimeNs end_ns) {
    for (; next_ < items_.size() && items_[next_].t_ns < end_ns; ++next_) write_item(items_[next_]);
  }

  void write_item(const ExportItem& item) {
    switch (item.kind) {
      case ExportItem::Kind::kPose:
        return write_pose(item);
      case ExportItem::Kind::kImu:
        ++counts_.imu_samples;
        return write(imu_topic_, item.t_ns, put_imu, imu_[item.index]);
      case ExportItem::Kind::kFrame:
        return write_frame(item);
      case ExportItem::Kind::kDepth:
        return write_depth(item);
    }
  }

  void write_pose(const ExportItem& item) {
    const Rigid3& pose = dataset_.groundtruth().poses()[item.index].world_from_camera;
    ++counts_.poses;
    write(pose_, item.t_ns, put_pose, item.t_ns, pose);
    if (is_for_viewers()) write(transform_, item.t_ns, put_transform, item.t_ns, pose);
  }

  void write_frame(const ExportItem& item) {
    ++counts_.frames;
    write_info(item.t_ns);
    const ImageU8 codes = srgb8_from_linear(dataset_.load_frame(item.index));
    write(image_, item.t_ns, [&](MessageBytes& message) { put_image(item.t_ns, codes, message); });
  }

  void write_depth(const ExportItem& item) {
    ++counts_.depth_maps;
    const ImageF depth = dataset_.load_depth(item.index);
    write(depth_, item.t_ns, [&](MessageBytes& message) { put_image(item.t_ns, depth, message); });
    if (!is_for_viewers() || dataset_.groundtruth().empty()) return;
    if (const auto pose = dataset_.groundtruth().at(seconds_from_ns(item.t_ns)))
      write(cloud_, item.t_ns, put_cloud, item.t_ns, points_of(depth, *pose));
  }

  [[nodiscard]] std::vector<Eigen::Vector3f> points_of(const ImageF& depth,
                                                       const Rigid3& world_from_camera) {
    const PinholeCamera& camera = dataset_.camera();
    if (!undistorted_) undistorted_.emplace(camera);
    std::vector<Eigen::Vector3f> points;
    for (int y = 0; y < depth.height(); ++y)
      for (int x = 0; x < depth.width(); ++x) {
        const double z = static_cast<double>(depth(x, y));
        if (!(z > 0) || !std::isfinite(z)) continue;
        const Eigen::Vector3d ray = camera.ray((*undistorted_)(x, y).cast<double>());
        points.push_back((world_from_camera * Eigen::Vector3d(z * ray)).cast<float>());
      }
    return points;
  }

  const Dataset& dataset_;
  std::unique_ptr<MessageFileWriter> writer_;
  SensorSize sensor_;
  EventMessages events_;
  std::vector<ImuSample> imu_;
  std::vector<ExportItem> items_;
  std::size_t next_ = 0;
  std::size_t left_out_ = 0;
  unsigned info_ = 0, image_ = 0, depth_ = 0, pose_ = 0, imu_topic_ = 0;
  unsigned picture_ = 0, transform_ = 0, cloud_ = 0;
  std::optional<TimeNs> picture_start_;
  ImageRgb8 canvas_;
  std::optional<UndistortionTable> undistorted_;
  ImportCounts counts_;
};

}  // namespace

ImportCounts write_ros_export(const std::filesystem::path& dataset,
                              const std::filesystem::path& file) {
  const Dataset opened = Dataset::open(dataset);
  return RosExport(opened, file).run();
}

}  // namespace saccade
