#include "estimator/odometry/start/plane_contrast.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace saccade {
namespace {

const PinholeCamera kCamera{120, 90, 100, 102, 59.5, 44.5, {-0.1, 0.02, 0, 0, 0}};
const PlaneMotion kTruth{{1.5, -0.8, 0.6}, {0.5, 0.8, 1}, {0.3, -0.2}};
constexpr double kDuration_s = 0.1;

/// Events of points on the plane: one each time a point enters another pixel.
Events before_plane(const PlaneMotion& truth) {
  Events events;
  const Random random(7);
  constexpr int kSteps = 400;
  for (std::uint64_t i = 0; i < 150; ++i) {
    const Eigen::Vector3d ray(1.4 * random.uniform(0, i) - 0.7, 1.1 * random.uniform(1, i) - 0.55,
                              1);
    const Eigen::Vector3d point = ray / truth.plane().dot(ray);
    int x = -1, y = -1;
    for (int step = 0; step <= kSteps; ++step) {
      const double t_s = kDuration_s * step / kSteps;
      const Rigid3 camera = truth.reference_from_camera(t_s - kDuration_s / 2);
      const Eigen::Vector2d pixel = kCamera.distort(kCamera.project(camera.inverse() * point));
      const auto u = static_cast<int>(std::lround(pixel.x()));
      const auto v = static_cast<int>(std::lround(pixel.y()));
      if (u == x && v == y) continue;
      x = u;
      y = v;
      if (u < 0 || v < 0 || u >= kCamera.width || v >= kCamera.height) continue;
      events.push_back(
          {ns_from_seconds(t_s), static_cast<std::uint16_t>(u), static_cast<std::uint16_t>(v), 1});
    }
  }
  std::sort(events.begin(), events.end(), EventOrder{});
  return events;
}

using Parameters = PlaneContrast::Parameters;

/// By how much the parameters move an event, roughly [px].
Parameters px_per_parameter(const PlaneContrast& contrast) {
  Parameters px = Parameters::Constant(contrast.px_per_rate());
  px.tail<2>() *= kTruth.velocity.norm();
  return px;
}

TEST(PlaneContrast, GradientIsThatOfTheContrast) {
  PlaneContrast contrast(kCamera, 1, {0, 0}, 5000);
  contrast.load(before_plane(kTruth));
  const Parameters px = px_per_parameter(contrast);
  for (const PlaneMotion& at : {PlaneMotion{}, PlaneMotion{{1, -0.4, 0.9}, {0.7, 1, 0.5}, {0, 0.3}},
                                PlaneMotion{{0.5, 0.2, -1}, {1, 2, 0}, {-0.2, -0.4}}}) {
    const Parameters place = PlaneContrast::parameters_of(at);
    const auto value = contrast.evaluate(place);
    Parameters numeric;
    for (int axis = 0; axis < place.size(); ++axis) {
      const double delta = 0.03 / px[axis];  // a move of some 0.03 px
      Parameters forward = place, backward = place;
      forward[axis] += delta;
      backward[axis] -= delta;
      numeric[axis] = (contrast.evaluate(forward).contrast - contrast.evaluate(backward).contrast) /
                      (2 * delta);
    }
    const Parameters difference = (value.gradient - numeric).cwiseQuotient(px);
    EXPECT_LT(difference.norm(), 0.02 * numeric.cwiseQuotient(px).norm() + 1e-5)
        << value.gradient.transpose() << "\n"
        << numeric.transpose();
  }
}

TEST(PlaneContrast, IsGreatestAtTheTruth) {
  PlaneContrast contrast(kCamera, 1, {0, 0}, 5000);
  contrast.load(before_plane(kTruth));
  const Parameters truth = PlaneContrast::parameters_of(kTruth);
  const Parameters px = px_per_parameter(contrast);
  const double greatest = contrast.evaluate(truth).contrast;
  for (int axis = 0; axis < truth.size(); ++axis)
    for (const double move_px : {-6.0, 6.0}) {
      Parameters moved = truth;
      moved[axis] += move_px / px[axis];
      EXPECT_LT(contrast.evaluate(moved).contrast, greatest) << axis << " " << move_px;
    }
}

}  // namespace
}  // namespace saccade
