#include "tests/support/direction_world.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/imu_sample.h"
#include "core/io/dataset/dataset_writer.h"
#include "core/io/images/exr_file.h"
#include "core/rigid3.h"

namespace saccade::testing {
namespace {

constexpr double kStep_s = 1e-3;
constexpr double kRest_s = 0.1;
constexpr double kNod = 0.1;

/// The camera's axes (right, down, forward) when it looks along +x and is level.
Eigen::Quaterniond level() {
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return Eigen::Quaterniond(axes);
}

Eigen::Vector3d rate_at(const OrientationFunction& turning, double t_s) {
  constexpr double kDelta_s = 1e-5;
  return so3_log(turning(t_s - kDelta_s).conjugate() * turning(t_s + kDelta_s)) / (2 * kDelta_s);
}

}  // namespace

double DirectionWorld::log_intensity(const Eigen::Vector3d& d) {
  const auto wave = [](double phase) { return std::tanh(10 * std::sin(phase)); };
  return -1.5 + 0.5 * wave(9 * d.x() + 5 * d.y()) + 0.4 * wave(11 * d.y() - 4 * d.z() + 1) +
         0.4 * wave(13 * d.z() + 6 * d.x()) + 0.3 * wave(17 * d.y() + 8 * d.z());
}

ImageF DirectionWorld::log_intensity(const Panorama& panorama) {
  ImageF image(panorama.width, panorama.height);
  for (int y = 0; y < panorama.height; ++y)
    for (int x = 0; x < panorama.width; ++x)
      image(x, y) = static_cast<float>(log_intensity(panorama.direction(x, y)));
  return image;
}

ImageF DirectionWorld::view(const Eigen::Quaterniond& world_from_camera) const {
  const PinholeCamera undistorted = camera_.undistorted();
  const UndistortionTable table(camera_);
  const Eigen::Matrix3d rotation = world_from_camera.toRotationMatrix();
  ImageF image(camera_.width, camera_.height);
  for (int y = 0; y < camera_.height; ++y)
    for (int x = 0; x < camera_.width; ++x) {
      const Eigen::Vector3d ray = undistorted.ray(table(x, y).cast<double>());
      image(x, y) = static_cast<float>(log_intensity(rotation * ray.normalized()));
    }
  return image;
}

Events DirectionWorld::simulate(const OrientationFunction& turning, double end_s,
                                double contrast) const {
  const auto c = static_cast<float>(contrast);
  ImageF before = view(turning(0));
  ImageF reference = before;
  Events events;
  for (int i = 1; i <= static_cast<int>(std::lround(end_s / kStep_s)); ++i) {
    const ImageF after = view(turning(kStep_s * i));
    for (int y = 0; y < camera_.height; ++y)
      for (int x = 0; x < camera_.width; ++x) {
        const float from = before(x, y), to = after(x, y);
        const float sign = to > from ? 1 : -1;
        while (sign * (to - reference(x, y)) >= c) {
          reference(x, y) += sign * c;
          const auto fraction = static_cast<double>((reference(x, y) - from) / (to - from));
          events.push_back({ns_from_seconds(kStep_s * (i - 1 + std::clamp(fraction, 0.0, 1.0))),
                            static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                            static_cast<std::int8_t>(sign)});
        }
      }
    before = after;
  }
  std::sort(events.begin(), events.end(), EventOrder{});
  return events;
}

PinholeCamera small_camera() { return {48, 36, 60, 60, 23.5, 17.5, {}}; }

OrientationFunction sweep(double start, double rate) {
  return [start, rate](double t_s) {
    const double moving_s = std::max(t_s - kRest_s, 0.0);
    // It starts and goes on without a jolt.
    const double yaw = start + rate * (moving_s - std::tanh(5 * moving_s) / 5);
    const double pitch = kNod * std::pow(std::sin(4 * moving_s), 2);
    return Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                              Eigen::AngleAxisd(-pitch, Eigen::Vector3d::UnitY())) *
           level();
  };
}

void write_sky_dataset(const std::filesystem::path& folder, const OrientationFunction& turning,
                       double end_s) {
  constexpr double kContrast = 0.15;
  const DirectionWorld world(small_camera());
  DatasetWriter writer(folder, world.camera());
  writer.write_events(world.simulate(turning, end_s, kContrast));
  std::vector<StampedPose> poses;
  std::vector<ImuSample> samples;
  for (int i = 0; i <= static_cast<int>(std::lround(end_s / kStep_s)); ++i) {
    const double t_s = kStep_s * i;
    poses.push_back({t_s, {turning(t_s), Eigen::Vector3d::Zero()}});
    ImuSample sample;
    sample.t_ns = ns_from_seconds(t_s);
    sample.angular_velocity = rate_at(turning, t_s);
    sample.specific_force = turning(t_s).conjugate() * Eigen::Vector3d(0, 0, 9.81);
    samples.push_back(sample);
  }
  writer.write_groundtruth(poses);
  writer.write_imu(samples);
  ImageF radiance = DirectionWorld::log_intensity(Panorama::sphere(pixels_around(120)));
  for (float& value : radiance.pixels()) value = std::exp(value) - 1e-3F;
  write_exr(folder / "panorama.exr", radiance, "Y");
  DatasetRecord record;
  record.name = "sky";
  record.duration_s = end_s;
  record.contrast_on = record.contrast_off = kContrast;
  (void)writer.finish(record);
}

double correlation(const ImageF& a, const ImageF& b, const ImageU8& mask) {
  double n = 0, sa = 0, sb = 0, aa = 0, ab = 0, bb = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask.pixels()[i] == 0) continue;
    const auto x = static_cast<double>(a.pixels()[i]);
    const auto y = static_cast<double>(b.pixels()[i]);
    ++n, sa += x, sb += y, aa += x * x, ab += x * y, bb += y * y;
  }
  return (ab - sa * sb / n) / std::sqrt((aa - sa * sa / n) * (bb - sb * sb / n));
}

}  // namespace saccade::testing
