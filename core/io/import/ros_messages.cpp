#include "core/io/import/ros_messages.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/check.h"
#include "core/io/images/picture_bytes.h"
#include "core/io/images/rgb_grey.h"

namespace saccade {
namespace {

constexpr std::string_view kTransform = "geometry_msgs/TransformStamped";
constexpr std::string_view kOdometry = "nav_msgs/Odometry";

Eigen::Vector3d read_vector(MessageReader& message) {
  Eigen::Vector3d v;
  for (int i = 0; i < 3; ++i) v[i] = message.number<double>();
  if (!v.allFinite()) message.fail("a vector is not finite");
  return v;
}

void skip_numbers(MessageReader& message, int count) {
  for (int i = 0; i < count; ++i) static_cast<void>(message.number<double>());
}

std::size_t channels_of(ImageMessage::Kind kind) {
  return kind == ImageMessage::Kind::kColour ? 3 : 1;
}

std::size_t pixel_bytes(const ImageMessage& image) {
  if (image.kind() != ImageMessage::Kind::kDepth) return channels_of(image.kind());
  return image.encoding == "16UC1" ? 2 : 4;
}

const std::byte* row_of(const ImageMessage& image, int y) {
  return image.data.data() + std::size_t{image.row_bytes} * static_cast<std::size_t>(y);
}

}  // namespace

ImuSample read_imu_message(MessageReader& message) {
  ImuSample sample;
  sample.t_ns = message.header();
  skip_numbers(message, 4 + 9);  // an orientation and its covariance
  sample.angular_velocity = read_vector(message);
  skip_numbers(message, 9);
  sample.specific_force = read_vector(message);
  return sample;
}

bool holds_poses(const MessageTopic& topic) {
  return topic.type == "geometry_msgs/PoseStamped" || topic.type == kTransform ||
         topic.type == kOdometry;
}

StampedPose read_pose_message(const MessageTopic& topic, MessageReader& message) {
  const double t_s = seconds_from_ns(message.header());
  // The name of the frame that moves.
  if (topic.type == kTransform || topic.type == kOdometry) static_cast<void>(message.text());
  const Eigen::Vector3d position = read_vector(message);
  std::array<double, 4> q{};
  for (double& part : q) part = message.number<double>();
  const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
  constexpr double kUnitTolerance = 1e-3;
  if (!(std::abs(rotation.norm() - 1) <= kUnitTolerance))
    message.fail(fmt::format("the quaternion's length is {:.6g}; a rotation's is 1 (within {})",
                             rotation.norm(), kUnitTolerance));
  return {t_s, {rotation, position}};
}

std::optional<PinholeCamera> read_camera_message(MessageReader& message) {
  PinholeCamera camera;
  static_cast<void>(message.header());
  const auto height = message.number<std::uint32_t>();
  const auto width = message.number<std::uint32_t>();
  const std::string_view model = message.text();
  const auto count = message.number<std::uint32_t>();
  std::vector<double> lens;
  for (std::uint32_t i = 0; i < count; ++i) lens.push_back(message.number<double>());
  std::array<double, 9> k{};
  for (double& entry : k) entry = message.number<double>();
  if (k[0] == 0) return std::nullopt;
  bool is_distorted = false;
  for (const double coefficient : lens) is_distorted = is_distorted || coefficient != 0;
  if (is_distorted && (model != "plumb_bob" || lens.size() > camera.distortion.size()))
    message.fail(
        fmt::format("the lens model '{}' with {} coefficients is not known; plumb_bob with "
                    "up to 5 is",
                    model, lens.size()));
  if (is_distorted) std::copy(lens.begin(), lens.end(), camera.distortion.begin());
  check_picture_size(width, height, "sensor_msgs/CameraInfo");
  camera.width = static_cast<int>(width);
  camera.height = static_cast<int>(height);
  camera.fx = k[0];
  camera.cx = k[2];
  camera.fy = k[4];
  camera.cy = k[5];
  camera.check("sensor_msgs/CameraInfo");
  return camera;
}

ImageMessage::Kind ImageMessage::kind() const {
  if (encoding == "mono8" || encoding == "8UC1") return Kind::kGrey;
  if (encoding == "rgb8" || encoding == "bgr8") return Kind::kColour;
  if (encoding == "32FC1" || encoding == "16UC1") return Kind::kDepth;
  return Kind::kOther;
}

ImageMessage read_image_message(MessageReader& message) {
  ImageMessage image;
  image.t_ns = message.header();
  image.height = message.number<std::uint32_t>();
  image.width = message.number<std::uint32_t>();
  image.encoding = message.text();
  const bool is_big = message.flag();
  image.row_bytes = message.number<std::uint32_t>();
  image.data = message.byte_array();
  if (image.kind() == ImageMessage::Kind::kOther) return image;
  if (is_big && image.kind() == ImageMessage::Kind::kDepth)
    message.fail("its depth is big-endian; little-endian numbers can be read");
  check_picture_size(image.width, image.height, "sensor_msgs/Image");
  if (image.row_bytes < std::uint64_t{image.width} * pixel_bytes(image) ||
      image.data.size() < std::uint64_t{image.row_bytes} * image.height)
    message.fail(fmt::format("{} bytes in rows of {} are no picture of {} x {} px",
                             image.data.size(), image.row_bytes, image.width, image.height));
  return image;
}

ImageU8 grey_of(const ImageMessage& image) {
  SACCADE_CHECK(image.is_picture());
  const auto width = static_cast<int>(image.width);
  const auto height = static_cast<int>(image.height);
  if (image.kind() == ImageMessage::Kind::kGrey) {
    ImageU8 grey(width, height);
    for (int y = 0; y < height; ++y)
      std::memcpy(&grey.pixels()[static_cast<std::size_t>(y) * image.width], row_of(image, y),
                  image.width);
    return grey;
  }
  const bool is_bgr = image.encoding == "bgr8";
  ImageRgb8 colours(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::byte* code = row_of(image, y) + 3 * static_cast<std::size_t>(x);
      for (std::size_t c = 0; c < 3; ++c)
        colours(x, y)[c] = std::to_integer<std::uint8_t>(code[is_bgr ? 2 - c : c]);
    }
  return grey_from(colours);
}

ImageF depth_of(const ImageMessage& image) {
  SACCADE_CHECK(image.kind() == ImageMessage::Kind::kDepth);
  constexpr float kMetresPerMillimetre = 1e-3F;
  ImageF depth(static_cast<int>(image.width), static_cast<int>(image.height));
  const std::size_t bytes = pixel_bytes(image);
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x) {
      const std::byte* at = row_of(image, y) + bytes * static_cast<std::size_t>(x);
      const float z = bytes == 2 ? kMetresPerMillimetre * load<std::uint16_t>(at) : load<float>(at);
      depth(x, y) = z > 0 && std::isfinite(z) ? z : 0;
    }
  return depth;
}

}  // namespace saccade
