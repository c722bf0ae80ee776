#include "core/io/ros/written_messages.h"

#include <array>

#include "core/check.h"
#include "core/io/files/byte_builder.h"

namespace saccade {
namespace {

constexpr std::string_view kCameraFrame = "camera";
constexpr std::string_view kWorldFrame = "world";

void put_vector(const Eigen::Vector3d& v, MessageBytes& message) {
  for (const double part : {v.x(), v.y(), v.z()}) message.number(part);
}

void put_quaternion(const Eigen::Quaterniond& q, MessageBytes& message) {
  for (const double part : {q.x(), q.y(), q.z(), q.w()}) message.number(part);
}

/// -1 in the first entry says that there is none.
void put_unknown_covariance(double first, MessageBytes& message) {
  message.number(first);
  for (int i = 1; i < 9; ++i) message.number(0.0);
}

template <class Pixel>
void put_image_of(TimeNs t_ns, const Image<Pixel>& image, std::string_view encoding,
                  MessageBytes& message) {
  message.header(t_ns, kCameraFrame);
  message.number(static_cast<std::uint32_t>(image.height()));
  message.number(static_cast<std::uint32_t>(image.width()));
  message.text(encoding);
  message.flag(false);  // little-endian
  message.number(
      static_cast<std::uint32_t>(static_cast<std::size_t>(image.width()) * sizeof(Pixel)));
  message.byte_array(std::as_bytes(image.pixels()));
}

void put_event_head(std::span<const Event> events, SensorSize sensor, MessageBytes& message) {
  SACCADE_CHECK(!events.empty());
  message.header(events.front().t_ns, kCameraFrame);
  message.number(static_cast<std::uint32_t>(sensor.height));
  message.number(static_cast<std::uint32_t>(sensor.width));
}

}  // namespace

void put_event_array(std::span<const Event> events, SensorSize sensor, MessageBytes& message) {
  put_event_head(events, sensor, message);
  message.number(static_cast<std::uint32_t>(events.size()));
  for (const Event& event : events) {
    message.number(event.x);
    message.number(event.y);
    message.time(event.t_ns);
    message.flag(event.polarity > 0);
  }
}

void put_event_packet(std::span<const Event> events, SensorSize sensor, std::uint64_t number,
                      MessageBytes& message) {
  put_event_head(events, sensor, message);
  const TimeNs base_ns = events.front().t_ns;
  message.number(number);
  message.number(static_cast<std::uint64_t>(base_ns));
  message.text("mono");
  message.flag(false);  // little-endian
  ByteBuilder words;
  for (const Event& event : events) {
    SACCADE_CHECK(event.t_ns - base_ns < TimeNs{1} << 32U && event.y < 1U << 15U);
    words.put(static_cast<std::uint64_t>(event.t_ns - base_ns) | std::uint64_t{event.x} << 32U |
              std::uint64_t{event.y} << 48U | std::uint64_t{event.polarity > 0 ? 1U : 0U} << 63U);
  }
  message.byte_array(words.bytes());
}

void put_image(TimeNs t_ns, const ImageU8& codes, MessageBytes& message) {
  put_image_of(t_ns, codes, "mono8", message);
}
void put_image(TimeNs t_ns, const ImageRgb8& codes, MessageBytes& message) {
  put_image_of(t_ns, codes, "rgb8", message);
}
void put_image(TimeNs t_ns, const ImageF& values, MessageBytes& message) {
  put_image_of(t_ns, values, "32FC1", message);
}

void put_imu(const ImuSample& sample, MessageBytes& message) {
  message.header(sample.t_ns, "imu");
  put_quaternion(Eigen::Quaterniond::Identity(), message);
  put_unknown_covariance(-1, message);
  put_vector(sample.angular_velocity, message);
  put_unknown_covariance(0, message);
  put_vector(sample.specific_force, message);
  put_unknown_covariance(0, message);
}

void put_pose(TimeNs t_ns, const Rigid3& world_from_camera, MessageBytes& message) {
  message.header(t_ns, kWorldFrame);
  put_vector(world_from_camera.translation(), message);
  put_quaternion(world_from_camera.rotation(), message);
}

void put_transform(TimeNs t_ns, const Rigid3& world_from_camera, MessageBytes& message) {
  message.number(std::uint32_t{1});
  message.header(t_ns, kWorldFrame);
  message.text(kCameraFrame);
  put_vector(world_from_camera.translation(), message);
  put_quaternion(world_from_camera.rotation(), message);
}

void put_camera_info(TimeNs t_ns, const PinholeCamera& camera, MessageBytes& message) {
  message.header(t_ns, kCameraFrame);
  message.number(static_cast<std::uint32_t>(camera.height));
  message.number(static_cast<std::uint32_t>(camera.width));
  message.text("plumb_bob");
  message.number(static_cast<std::uint32_t>(camera.distortion.size()));
  message.numbers(camera.distortion);
  const auto& [fx, fy, cx, cy] = std::array{camera.fx, camera.fy, camera.cx, camera.cy};
  message.numbers(std::array{fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0});
  message.numbers(std::array{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0});
  message.numbers(std::array{fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0});
  for (int i = 0; i < 6; ++i) message.number(std::uint32_t{0});  // binning and region
  message.flag(false);
}

void put_cloud(TimeNs t_ns, std::span<const Eigen::Vector3f> points_in_world,
               MessageBytes& message) {
  constexpr std::uint32_t kPointBytes = 3 * sizeof(float);
  constexpr std::uint8_t kFloat32 = 7;
  static_assert(sizeof(Eigen::Vector3f) == kPointBytes);
  message.header(t_ns, kWorldFrame);
  message.number(std::uint32_t{1});
  message.number(static_cast<std::uint32_t>(points_in_world.size()));
  message.number(std::uint32_t{3});
  std::uint32_t offset = 0;
  for (const std::string_view axis : {"x", "y", "z"}) {
    message.text(axis);
    message.number(offset);
    message.number(kFloat32);
    message.number(std::uint32_t{1});
    offset += sizeof(float);
  }
  message.flag(false);  // little-endian
  message.number(kPointBytes);
  message.number(static_cast<std::uint32_t>(kPointBytes * points_in_world.size()));
  message.byte_array(std::as_bytes(points_in_world));
  message.flag(true);  // no point is missing
}

}  // namespace saccade
