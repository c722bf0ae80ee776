#pragma once

#include <optional>
#include <string>

#include "core/spline/spline.h"
#include "simulator/motion/motion_options.h"

namespace saccade {

/// The spline that `options` describe; it is the ground truth, whatever it was made from. Keeps the
/// times of the file, the waypoints or the timed control poses (whose first segment starts at the
/// second one); everything else starts at 0. A preset is sampled densely in its closed form and
/// interpolated, within 1e-6 of its size. Throws InputError for what describe() could not check: a
/// file with fewer than two poses, rotations without a spline through them, a view without
/// direction. `name`: of the section in errors.
[[nodiscard]] Spline build_motion(const MotionOptions& options,
                                  const std::string& name = "trajectory");

/// The piece that is simulated: from `start_s` after the motion's first pose, `duration_s` long
/// (default: up to the end), its time starting at 0. Throws InputError naming the key, with the
/// motion's span.
[[nodiscard]] Spline cut_motion(const Spline& motion, double start_s,
                                std::optional<double> duration_s);

}  // namespace saccade
