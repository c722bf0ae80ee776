#include "simulator/scene/background.h"

#include <cmath>
#include <numbers>

namespace saccade {

double Background::map_radiance(const Eigen::Vector3d& direction) const {
  const double azimuth = std::atan2(direction.y(), direction.x());
  const double elevation = std::atan2(direction.z(), direction.head<2>().norm());
  return map_->at(0.5 - azimuth / (2 * std::numbers::pi), 0.5 + elevation / std::numbers::pi);
}

}  // namespace saccade
