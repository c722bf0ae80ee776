#include "simulator/exposure.h"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

/// The fastest pixel at `t_s` [px/s].
double image_speed(const ImageRenderer& renderer, const Spline& motion, double t_s) {
  const FlowField flow = renderer.flow(motion.state(t_s), t_s);
  float speed = 0;
  for (std::size_t i = 0; i < flow.u.size(); ++i)
    speed = std::max(speed, std::hypot(flow.u.pixels()[i], flow.v.pixels()[i]));
  return static_cast<double>(speed);
}

}  // namespace

std::vector<double> exposure_times(const ImageRenderer& renderer, const Spline& world_from_camera,
                                   double t_s, double exposure_s) {
  constexpr double kMotion_px = 0.25;
  constexpr double kMaxTimes = 256;
  if (exposure_s <= 0) return {t_s};
  const double from_s = std::max(world_from_camera.start_s(), t_s - 0.5 * exposure_s);
  const double to_s = std::min(world_from_camera.end_s(), t_s + 0.5 * exposure_s);
  // At several instants, since the camera may turn round within the exposure.
  double speed = 0;
  for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0})
    speed =
        std::max(speed, image_speed(renderer, world_from_camera, from_s + part * (to_s - from_s)));
  const double count = std::clamp(std::ceil(speed * (to_s - from_s) / kMotion_px), 1.0, kMaxTimes);
  std::vector<double> times;
  for (double k = 0.5; k < count; ++k) times.push_back(from_s + (to_s - from_s) * k / count);
  return times;
}

}  // namespace saccade
