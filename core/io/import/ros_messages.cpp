#include "core/io/import/ros_messages.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>

#include "core/io/images/picture_bytes.h"
#include "core/io/images/rgb_grey.h"

namespace saccade {
namespace {

Eigen::Vector3d read_vector(BagMessageReader& message) {
  Eigen::Vector3d v;
  for (int i = 0; i < 3; ++i) v[i] = message.number<double>();
  if (!v.allFinite()) message.fail("a vector is not finite");
  return v;
}

void skip_covariance(BagMessageReader& message) {
  static_cast<void>(message.take(9 * sizeof(double)));
}

/// Codes of three colours -> grey, whichever comes first.
ImageU8 grey_of_colours(const ImageU8& codes, bool is_bgr) {
  ImageRgb8 colours(codes.width() / 3, codes.height());
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const std::uint8_t* code = codes.data() + 3 * i;
    colours.data()[i] = is_bgr ? Rgb8{code[2], code[1], code[0]} : Rgb8{code[0], code[1], code[2]};
  }
  return grey_from(colours);
}

}  // namespace

ImuSample read_imu_message(BagMessageReader& message) {
  ImuSample sample;
  sample.t_ns = message.header();
  static_cast<void>(message.take(4 * sizeof(double)));  // an orientation
  skip_covariance(message);
  sample.angular_velocity = read_vector(message);
  skip_covariance(message);
  sample.specific_force = read_vector(message);
  return sample;
}

StampedPose read_pose_message(BagMessageReader& message) {
  const double t_s = seconds_from_ns(message.header());
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

std::optional<PinholeCamera> read_camera_message(BagMessageReader& message) {
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

StampedPicture read_image_message(BagMessageReader& message) {
  StampedPicture picture;
  picture.t_ns = message.header();
  const auto height = message.number<std::uint32_t>();
  const auto width = message.number<std::uint32_t>();
  const std::string_view encoding = message.text();
  static_cast<void>(message.number<std::uint8_t>());  // whether numbers are big-endian: bytes
  const auto row_bytes = message.number<std::uint32_t>();
  const bool is_grey = encoding == "mono8" || encoding == "8UC1";
  const bool is_bgr = encoding == "bgr8";
  if (!is_grey && !is_bgr && encoding != "rgb8")
    message.fail(
        fmt::format("pictures of the encoding '{}' cannot be read; mono8, 8UC1, rgb8 and "
                    "bgr8 can",
                    encoding));
  check_picture_size(width, height, "sensor_msgs/Image");
  const std::uint64_t used_bytes = std::uint64_t{width} * (is_grey ? 1U : 3U);
  const std::span<const std::byte> data = message.take(message.number<std::uint32_t>());
  if (row_bytes < used_bytes || data.size() < std::uint64_t{row_bytes} * height)
    message.fail(fmt::format("{} bytes in rows of {} are no picture of {} x {} px", data.size(),
                             row_bytes, width, height));
  ImageU8 codes(static_cast<int>(used_bytes), static_cast<int>(height));
  for (std::uint32_t y = 0; y < height; ++y)
    std::memcpy(codes.data() + y * used_bytes, data.data() + std::uint64_t{y} * row_bytes,
                used_bytes);
  picture.grey = is_grey ? std::move(codes) : grey_of_colours(codes, is_bgr);
  return picture;
}

}  // namespace saccade
