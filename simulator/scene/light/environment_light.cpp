#include "simulator/scene/light/environment_light.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/check.h"
#include "simulator/scene/mesh/file_source.h"

namespace saccade {
namespace {

using std::numbers::pi;

/// Integrals over an interval of azimuth of 1, cos, sin, cos^2, cos sin and sin^2.
using AzimuthMoments = std::array<double, 6>;

/// Their antiderivatives.
AzimuthMoments azimuth_moments(double a) {
  return {a,
          std::sin(a),
          -std::cos(a),
          0.5 * a + 0.25 * std::sin(2 * a),
          -0.25 * std::cos(2 * a),
          0.5 * a - 0.25 * std::sin(2 * a)};
}

/// Integrals over an interval of z, the sine of the elevation, of 1, r, z, r^2, r z and z^2, with
/// r = sqrt(1 - z^2): their antiderivatives.
std::array<double, 6> height_moments(double elevation) {
  const double z = std::sin(elevation);
  const double r = std::cos(elevation);
  return {
      z, 0.5 * (z * r + elevation), 0.5 * z * z, z - z * z * z / 3, -r * r * r / 3, z * z * z / 3};
}

template <std::size_t n>
std::array<double, n> operator-(std::array<double, n> a, const std::array<double, n>& b) {
  for (std::size_t k = 0; k < n; ++k) a[k] -= b[k];
  return a;
}

/// Of each column, whose azimuth falls from pi - over a whole turn.
std::vector<AzimuthMoments> columns_of(int width, double yaw_rad) {
  std::vector<AzimuthMoments> columns;
  const double step = 2 * pi / width;
  for (int i = 0; i < width; ++i) {
    const double left = pi - i * step + yaw_rad;
    columns.push_back(azimuth_moments(left) - azimuth_moments(left - step));
  }
  return columns;
}

/// int L dw, int L w dw and int L w w^T dw.
struct Moments {
  double zeroth = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
};

Moments moments_of(const ImageF& map, double yaw_rad) {
  const std::vector<AzimuthMoments> columns = columns_of(map.width(), yaw_rad);
  Moments sum;
  for (int j = 0; j < map.height(); ++j) {
    AzimuthMoments row{};
    for (int i = 0; i < map.width(); ++i)
      for (std::size_t k = 0; k < row.size(); ++k)
        row[k] += static_cast<double>(map(i, j)) * columns[static_cast<std::size_t>(i)][k];
    const double step = pi / map.height();
    const double top = pi / 2 - j * step;
    const auto h = height_moments(top) - height_moments(top - step);
    sum.zeroth += row[0] * h[0];
    sum.first += Eigen::Vector3d(row[1] * h[1], row[2] * h[1], row[0] * h[2]);
    Eigen::Matrix3d second;
    second << row[3] * h[3], row[4] * h[3], row[1] * h[4],  //
        row[4] * h[3], row[5] * h[3], row[2] * h[4],        //
        row[1] * h[4], row[2] * h[4], row[0] * h[5];
    sum.second += second;
  }
  return sum;
}

}  // namespace

EnvironmentLight::EnvironmentLight(const ImageF& map, double yaw_deg, double scale) {
  SACCADE_CHECK(map.width() > 0 && map.height() > 0);
  const Moments moments = moments_of(map, yaw_deg * pi / 180);
  constant_ = scale * 3 / (32 * pi) * moments.zeroth;
  linear_ = scale / (2 * pi) * moments.first;
  quadratic_ = scale * 15 / (32 * pi) * moments.second;
}

LightRange EnvironmentLight::range(const VectorRange& normal) const {
  // constant_ + n . (linear_ + quadratic_ n)
  VectorRange factor;
  for (std::size_t i = 0; i < factor.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    factor[i] = {linear_[row], linear_[row], 0, 0};
    for (std::size_t k = 0; k < factor.size(); ++k) {
      const double part = quadratic_(row, static_cast<Eigen::Index>(k));
      factor[i].add(product({part, part, 0, 0}, normal[k]));
    }
  }
  LightRange sum = dot(normal, factor);
  sum.add({constant_, constant_, 0, 0});
  return positive_part(sum);
}

void describe(config::Fields& fields, EnvironmentLightOptions& options) {
  fields
      .value("scale", options.scale,
             "Factor of the radiance of the surroundings, as far as they light surfaces.")
      .at_least(0);
  fields.value(
      "picture", options.picture,
      "Equirectangular picture of the surroundings in place of the background, which stays "
      "what the camera sees.");
  if (fields.reading() && options.picture) {
    const std::string problem = missing_file_problem(*options.picture);
    fields.expect(problem.empty(), "picture", problem);
  }
}

}  // namespace saccade
