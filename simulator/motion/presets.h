#pragma once

#include <functional>

#include "core/rigid3.h"
#include "simulator/motion/motion_options.h"

namespace saccade {

/// A preset in closed form, defined for every time [s], also outside its duration.
struct Preset {
  std::function<Rigid3(double)> world_from_camera;
  double shortest_period_s;  ///< of its fastest part
};

/// The closed form behind a preset source. Throws InputError where a view direction is undefined.
[[nodiscard]] Preset make_preset(const MotionOptions& options);

/// The camera's rotation at `position`; throws InputError naming `look_at` or `up` where it is
/// undefined.
[[nodiscard]] Eigen::Quaterniond orientation_at(const PresetOrientation& options,
                                                const Eigen::Vector3d& position);

}  // namespace saccade
