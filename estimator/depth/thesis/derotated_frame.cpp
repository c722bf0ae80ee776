#include "estimator/depth/thesis/derotated_frame.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace saccade {
namespace {

/// Within a chunk the homography is linear in time: at 10 rad/s its error stays below 0.003 px for
/// f = 250 px.
constexpr TimeNs kChunkNs = 1'000'000;
constexpr std::size_t kChunkEvents = 256;

}  // namespace

Derotation::Derotation(const PinholeCamera& camera, const UndistortionTable& undistortion,
                       const Trajectory& trajectory, const Eigen::Quaterniond& world_from_reference)
    : camera_(camera),
      undistortion_(undistortion),
      trajectory_(trajectory),
      reference_from_world_(world_from_reference.conjugate()) {}

Eigen::Matrix3d Derotation::homography(double t_s) const {
  const Eigen::Quaterniond reference_from_camera =
      reference_from_world_ * trajectory_.at_clamped(t_s).rotation();
  const Eigen::Matrix3d k = camera_.matrix();
  return k * reference_from_camera.toRotationMatrix() * k.inverse();
}

ImageF Derotation::draw(std::span<const Event> events) const {
  ImageF frame(camera_.width, camera_.height);
  for (std::size_t begin = 0; begin < events.size();) {
    std::size_t end = begin + 1;
    while (end < events.size() && end - begin < kChunkEvents &&
           events[end].t_ns - events[begin].t_ns < kChunkNs)
      ++end;
    draw_chunk(events.subspan(begin, end - begin), frame);
    begin = end;
  }
  return frame;
}

void Derotation::draw_chunk(std::span<const Event> chunk, ImageF& frame) const {
  const TimeNs start_ns = chunk.front().t_ns;
  const TimeNs length_ns = std::max<TimeNs>(chunk.back().t_ns - start_ns, 1);
  const Eigen::Matrix3d from = homography(seconds_from_ns(start_ns));
  const Eigen::Matrix3d change = homography(seconds_from_ns(start_ns + length_ns)) - from;
  for (const Event& event : chunk) {
    const double fraction =
        static_cast<double>(event.t_ns - start_ns) / static_cast<double>(length_ns);
    const Eigen::Vector3d pixel = undistortion_(event.x, event.y).cast<double>().homogeneous();
    const Eigen::Vector3d p = from * pixel + fraction * (change * pixel);  // (5.15)
    if (p.z() <= 0) continue;
    const double x = p.x() / p.z();
    const double y = p.y() / p.z();
    if (is_inside(frame, x, y)) splat(frame, x, y, 1.F);
  }
}

void normalise_frame(ImageF& frame) {
  for (float& value : frame.pixels()) value = std::log1p(value);
  double sum = 0;
  for (const float value : frame.pixels()) sum += static_cast<double>(value) * value;
  if (sum <= 0) return;
  const auto scale = static_cast<float>(std::sqrt(static_cast<double>(frame.size()) / sum));
  for (float& value : frame.pixels()) value *= scale;
}

}  // namespace saccade
