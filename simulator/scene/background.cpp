#include "simulator/scene/background.h"

#include <cmath>
#include <numbers>

namespace saccade {

SurfaceSample Background::sample_map(const Eigen::Vector3d& direction) const {
  const double azimuth = std::atan2(direction.y(), direction.x());
  const double elevation = std::atan2(direction.z(), direction.head<2>().norm());
  const double u = 0.5 - azimuth / (2 * std::numbers::pi) + turns_;
  const double v = 0.5 + elevation / std::numbers::pi;
  return {map_.get(), u * map_->width() - 0.5, (1 - v) * map_->height() - 0.5};
}

}  // namespace saccade
