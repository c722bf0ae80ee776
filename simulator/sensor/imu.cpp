#include "simulator/sensor/imu.h"

#include <array>
#include <cmath>

namespace saccade {
namespace {

using Rows = std::array<std::array<double, 4>, 4>;

Rows rows_of(const Rigid3& transform) {
  const Eigen::Matrix3d r = transform.rotation_matrix();
  const Eigen::Vector3d& t = transform.translation();
  Rows rows{};
  for (int i = 0; i < 3; ++i) rows[static_cast<std::size_t>(i)] = {r(i, 0), r(i, 1), r(i, 2), t[i]};
  rows[3] = {0, 0, 0, 1};
  return rows;
}

/// False unless the rows are a rigid transformation.
bool read_rows(const Rows& rows, Rigid3& transform) {
  constexpr double kTolerance = 1e-3;
  Eigen::Matrix3d r;
  for (int i = 0; i < 3; ++i) {
    const auto& row = rows[static_cast<std::size_t>(i)];
    r.row(i) << row[0], row[1], row[2];
  }
  const bool rotates =
      (r.transpose() * r - Eigen::Matrix3d::Identity()).norm() < kTolerance && r.determinant() > 0;
  if (!rotates || rows[3] != std::array<double, 4>{0, 0, 0, 1}) return false;
  transform = {Eigen::Quaterniond(r), {rows[0][3], rows[1][3], rows[2][3]}};
  return true;
}

}  // namespace

void describe(config::Fields& fields, ImuOptions& options) {
  fields.value("rate_hz", options.rate_hz, "samples per second; 0: no IMU").range(0, 1e6);
  Rows rows = rows_of(options.camera_from_imu);
  fields.value("T_camera_imu", rows, "4 x 4, point in the camera = T * point in the IMU [m]");
  if (!fields.has("T_camera_imu")) return;
  fields.expect(read_rows(rows, options.camera_from_imu), "T_camera_imu",
                "is no rigid transformation: a rotation, a translation, and 0 0 0 1 below");
}

ImuSample imu_sample(const Spline& motion, const Rigid3& camera_from_imu,
                     const Eigen::Vector3d& gravity_m_s2, TimeNs t_ns) {
  const SplineState imu = motion.state(seconds_from_ns(t_ns)).attached(camera_from_imu);
  const Eigen::Quaterniond imu_from_world = imu.world_from_body.rotation().conjugate();
  return {t_ns, imu_from_world * (imu.acceleration_in_world - gravity_m_s2),
          imu.angular_velocity_in_body};
}

std::vector<ImuSample> imu_samples(const Spline& motion, const ImuOptions& options,
                                   const Eigen::Vector3d& gravity_m_s2) {
  std::vector<ImuSample> samples;
  if (options.rate_hz <= 0) return samples;
  const TimeNs end_ns = ns_from_seconds(motion.end_s());
  for (std::size_t k = 0;; ++k) {
    const TimeNs t_ns = ns_from_seconds(static_cast<double>(k) / options.rate_hz);
    if (t_ns > end_ns) return samples;
    samples.push_back(imu_sample(motion, options.camera_from_imu, gravity_m_s2, t_ns));
  }
}

}  // namespace saccade
