#pragma once

#include <span>
#include <string_view>

#include "estimator/odometry/odometry.h"

namespace saccade {

/// A method of odometry: what its keyframes are made of and how they are tracked by. The options of
/// depth, reconstruction and tracking are the method's; what a user sets of them are the keys of
/// odometry_config.cpp.
struct OdometryMethod {
  std::string_view name;  ///< value of the key `method`
  std::string_view help;  ///< a sentence
  OdometryOptions (*preset)();
};

/// The first is the default.
[[nodiscard]] std::span<const OdometryMethod> odometry_methods();

/// The preset of a method that there is.
[[nodiscard]] OdometryOptions odometry_preset(std::string_view method);

}  // namespace saccade
