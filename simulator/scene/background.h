#pragma once

#include <memory>

#include <Eigen/Core>

#include "simulator/scene/scene.h"
#include "simulator/scene/texture/texture.h"

namespace saccade {

/// Light from where nothing is: a constant, or an environment map. The map is equirectangular: its
/// middle column looks along +x, columns to the left turn towards +y, its top row is +z. `yaw_deg`
/// turns it about +z, from +x towards +y.
class Background {
 public:
  explicit Background(double radiance) : radiance_(radiance) {}
  explicit Background(ImageF map, double yaw_deg = 0)
      : map_(std::make_shared<Texture>(std::move(map), Wrap::kRepeat, Wrap::kClamp)),
        turns_(yaw_deg / 360) {}

  /// What is seen along `direction` (not zero, of any length).
  [[nodiscard]] SurfaceSample sample(const Eigen::Vector3d& direction) const {
    return map_ ? sample_map(direction) : SurfaceSample{.x = radiance_};
  }

 private:
  [[nodiscard]] SurfaceSample sample_map(const Eigen::Vector3d& direction) const;

  double radiance_ = 0;
  std::shared_ptr<const Texture> map_;
  double turns_ = 0;
};

}  // namespace saccade
