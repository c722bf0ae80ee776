#pragma once

#include <Eigen/Geometry>

#include "simulator/scene/mesh/model.h"

namespace saccade {

/// Whether a track of values of `width` numbers can be read: as many values as its keys need, all
/// finite, at times that do not decrease.
[[nodiscard]] bool is_valid(const ModelTrack& track, std::size_t width);

/// The value at a time, the nearest key's outside all of them. The track is valid and has keys.
[[nodiscard]] Eigen::Vector3d vector_at(const ModelTrack& track, double t_s);
/// Along the shorter arc at constant rate between two keys; cubic ones are normalised (Khronos,
/// glTF 2.0, appendix C).
[[nodiscard]] Eigen::Quaterniond rotation_at(const ModelTrack& track, double t_s);

}  // namespace saccade
