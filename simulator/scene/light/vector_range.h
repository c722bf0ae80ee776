#pragma once

#include <array>

#include <Eigen/Core>

#include "simulator/scene/light/flicker.h"

namespace saccade {

/// Bounds of the parts of a vector, and of their rates of change, over an interval of time. Parts
/// may be negative.
using VectorRange = std::array<LightRange, 3>;

/// Of what stays near the line between its values at both ends, within a quarter of its change.
[[nodiscard]] LightRange range_near_line(double from, double to, double length_s);
[[nodiscard]] VectorRange range_near_line(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                          double length_s);

/// Of the product of two quantities of any sign.
[[nodiscard]] LightRange product(const LightRange& a, const LightRange& b);
/// Of max(0, a).
[[nodiscard]] LightRange positive_part(LightRange a);
[[nodiscard]] LightRange dot(const VectorRange& a, const VectorRange& b);
[[nodiscard]] VectorRange cross(const VectorRange& a, const VectorRange& b);
[[nodiscard]] VectorRange sum(VectorRange a, const VectorRange& b);
[[nodiscard]] LightRange squared_norm(const VectorRange& vector);
/// Of a vector divided by its length.
[[nodiscard]] VectorRange unit(const VectorRange& vector);

}  // namespace saccade
