#include "core/io/import/h5_arrays.h"

#include <fmt/format.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace saccade {
namespace {

void expect_images(const H5File& file, const std::string& path, int width, int height) {
  const std::vector<std::uint64_t> shape = file.shape(path);
  if (shape.size() != 3 || shape[1] != static_cast<std::uint64_t>(height) ||
      shape[2] != static_cast<std::uint64_t>(width))
    file.fail(path, fmt::format("must hold images of {} x {} px", width, height));
}

}  // namespace

Rigid3 rigid_of(const double* rows, const std::string& location) {
  const auto matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(rows);
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  constexpr double kTolerance = 1e-3;
  if (!matrix.allFinite() ||
      !((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < kTolerance) ||
      !(rotation.determinant() > 0))
    throw InputError(location, "is no rigid transformation (within 1e-3)");
  return {Eigen::Quaterniond(rotation), matrix.topRightCorner<3, 1>()};
}

std::vector<StampedPose> read_h5_poses(const H5File& file, const std::string& matrices,
                                       const std::string& times, double unit_s, bool inverted) {
  const std::vector<double> entries = file.numbers(matrices);
  const std::vector<double> stamps = file.numbers(times);
  if (entries.size() != 16 * stamps.size())
    file.fail(matrices, fmt::format("holds {} numbers for {} times; a pose is a matrix of 4 x 4",
                                    entries.size(), stamps.size()));
  std::vector<StampedPose> poses;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const double* rows = entries.data() + 16 * i;
    if (!std::all_of(rows, rows + 16, [](double x) { return std::isfinite(x); })) continue;
    const double t_s = unit_s * stamps[i];
    if (!poses.empty() && !(t_s > poses.back().t_s)) continue;
    const Rigid3 pose = rigid_of(rows, file.location(fmt::format("{}[{}]", matrices, i)));
    poses.push_back({t_s, inverted ? pose.inverse() : pose});
  }
  return poses;
}

std::vector<double> read_h5_times(const H5File& file, const std::string& path, double unit_s) {
  std::vector<double> times = file.numbers(path);
  for (std::size_t i = 0; i < times.size(); ++i) {
    times[i] *= unit_s;
    if (!std::isfinite(times[i]) || (i > 0 && !(times[i] > times[i - 1])))
      file.fail(fmt::format("{}[{}]", path, i), "times must increase");
  }
  return times;
}

ImageF read_h5_depth(const H5File& file, const std::string& path, std::size_t index, int width,
                     int height) {
  expect_images(file, path, width, height);
  const std::vector<float> values = file.floats_at(path, index);
  ImageF depth(width, height);
  std::transform(values.begin(), values.end(), depth.data(),
                 [](float z) { return std::isfinite(z) && z > 0 ? z : 0; });
  return depth;
}

ImageU8 read_h5_grey(const H5File& file, const std::string& path, std::size_t index, int width,
                     int height) {
  expect_images(file, path, width, height);
  const std::vector<std::uint8_t> values = file.bytes_at(path, index);
  ImageU8 grey(width, height);
  std::copy(values.begin(), values.end(), grey.data());
  return grey;
}

}  // namespace saccade
