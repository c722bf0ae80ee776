#include "simulator/motion/transform_options.h"

#include <Eigen/Geometry>

#include <numbers>

#include "core/config/fields.h"

namespace saccade {

void describe(config::Fields& fields, TransformOptions& options) {
  fields.value("translation", options.translation, "Translation, in metres.").range(-1e6, 1e6);
  fields
      .value("rotation_deg", options.rotation_deg, "Rotation about x, then y, then z, in degrees.")
      .range(-36000, 36000);
  const char* const help = "Scale before the rotation: one factor, or one each for x, y and z.";
  const Eigen::Vector3d& scale = options.scale;
  const bool one_number = fields.reading() ? fields.form("scale") != config::Form::kList
                                           : scale.x() == scale.y() && scale.x() == scale.z();
  if (one_number) {
    double factor = scale.x();
    fields.value("scale", factor, help).above(0);
    options.scale.setConstant(factor);
  } else {
    fields.value("scale", options.scale, help).above(0);
  }
}

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& angles_deg) {
  const Eigen::Vector3d angles = angles_deg * (std::numbers::pi / 180);
  return (Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace saccade
