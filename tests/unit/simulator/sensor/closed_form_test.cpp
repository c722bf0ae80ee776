// Signals whose crossings are known without any rendering.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <vector>

#include "simulator/sensor/image_renderer.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

using testing::ClosedFormPlane;
using testing::ExactEvent;

void expect_exact(const std::vector<ExactEvent>& expected, const Events& found,
                  const PinholeCamera& camera) {
  const testing::ExactMatch match =
      testing::match_exact(expected, found, camera.width, camera.height);
  std::printf("events %zu of %zu, wrong pixels %zu, |dt| median %.4f p99 %.4f max %.4f us\n",
              match.found, match.expected, match.wrong_pixels, match.median_us, match.p99_us,
              match.max_us);
  EXPECT_GT(match.expected, 200U);
  EXPECT_EQ(match.found, match.expected);
  EXPECT_EQ(match.wrong_pixels, 0U);
  EXPECT_LE(match.median_us, 0.1);
  EXPECT_LE(match.p99_us, 1);
}

void expect_exact(const ClosedFormPlane& plane) {
  const EventOptions options = testing::in_nanoseconds();
  const Events events =
      testing::record(testing::scene_of(plane), plane.motion(), plane.camera, options).events;
  expect_exact(plane.events(options.contrast.on, options.contrast.off, options.log_eps), events,
               plane.camera);
}

/// A plane whose radiance is a function of the texture's column.
ClosedFormPlane striped(const std::function<double(int)>& radiance) {
  ClosedFormPlane plane = ClosedFormPlane::smooth(25, 13);
  for (int j = 0; j < plane.texture.height(); ++j)
    for (int i = 0; i < plane.texture.width(); ++i)
      plane.texture(i, j) = static_cast<float>(radiance(i));
  return plane;
}

TEST(ClosedForm, Ramp) {
  expect_exact(striped([](int i) { return 0.1 + 0.9 * i / 256; }));
}

TEST(ClosedForm, Sine) {
  expect_exact(striped([](int i) { return std::exp(-1 + 0.93 * std::sin(0.4 * i)); }));
}

TEST(ClosedForm, StepEdge) {
  expect_exact(striped([](int i) { return i % 64 < 32 ? 0.1 : 0.9; }));
}

/// The crossings of pixels whose signal is `log_intensity(x, y, t_s)`, bisected on a grid
/// fine enough for smooth signals.
std::vector<ExactEvent> crossings(const PinholeCamera& camera, double end_s, double contrast,
                                  const std::function<double(int, int, double)>& log_intensity) {
  constexpr double kStep_s = 1e-5;
  std::vector<ExactEvent> events;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const auto value = [&](double t_s) { return log_intensity(x, y, t_s); };
      double from_s = 0;
      const double first = value(0);
      int level = 0;
      const auto go_to = [&](double to_s) {
        while (true) {
          const double units = (value(to_s) - first) / contrast - level;
          if (std::abs(units) < 1) break;
          const int sign = units > 0 ? 1 : -1;
          const double threshold = first + contrast * (level + sign);
          double lo = from_s, hi = to_s;
          while (hi - lo > 1e-11) {
            const double middle = 0.5 * (lo + hi);
            (sign * (value(middle) - threshold) < 0 ? lo : hi) = middle;
          }
          events.push_back({hi, x, y, sign});
          level += sign;
          from_s = hi;
        }
        from_s = to_s;
      };
      for (double t_s = kStep_s; t_s <= end_s; t_s += kStep_s) go_to(t_s);
    }
  return events;
}

ImageF panorama(int width, int height) {
  ImageF map(width, height);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const double azimuth = 2 * std::numbers::pi * i / width;
      const double polar = std::numbers::pi * j / height;
      map(i, j) = static_cast<float>(
          std::exp(-1 + 0.6 * std::sin(24 * azimuth + 3 * polar) + 0.5 * std::cos(31 * polar)));
    }
  return map;
}

/// Bilinear interpolant of an equirectangular map: the middle column looks along +x, columns to the
/// left turn towards +y, the top row is +z.
double seen(const ImageF& map, const Eigen::Vector3d& direction) {
  const double azimuth = std::atan2(direction.y(), direction.x());
  const double elevation = std::asin(direction.z() / direction.norm());
  const double x = (0.5 - azimuth / (2 * std::numbers::pi)) * map.width() - 0.5;
  const double y = (0.5 - elevation / std::numbers::pi) * map.height() - 0.5;
  const double i = std::floor(x);
  const double j = std::floor(y);
  const auto texel = [&](double column, double row) {
    const int wrapped = (static_cast<int>(column) + map.width()) % map.width();
    return static_cast<double>(map(wrapped, static_cast<int>(row)));
  };
  const double top = texel(i, j) + (x - i) * (texel(i + 1, j) - texel(i, j));
  const double bottom = texel(i, j + 1) + (x - i) * (texel(i + 1, j + 1) - texel(i, j + 1));
  return top + (y - j) * (bottom - top);
}

// The view passes over the seam of the map, behind the camera's first direction.
TEST(ClosedForm, RotationBeforeAPanorama) {
  const ImageF map = panorama(512, 256);
  SceneBuilder builder;
  builder.add(testing::rectangle({0, 0, 50}, {0.1, 0, 0}, {0, 0.1, 0}, ImageF(2, 2, 1)),
              Eigen::Affine3d::Identity());
  const Scene scene = std::move(builder).build(Background(map));
  const PinholeCamera camera{17, 9, 60, 60, 8, 4, {}};
  const Eigen::Vector3d rate(0.4, -2.2, 0.9);
  // Looks along -x, the image's right is +y, its bottom -z.
  Eigen::Matrix3d start;
  start.col(0) = Eigen::Vector3d::UnitY();
  start.col(1) = -Eigen::Vector3d::UnitZ();
  start.col(2) = -Eigen::Vector3d::UnitX();
  constexpr double kDuration_s = 0.25;
  std::vector<StampedPose> poses(2);
  poses[0].world_from_camera = Rigid3(Eigen::Quaterniond(start), {0, 0, 0});
  poses[1] = {kDuration_s,
              Rigid3(Eigen::Quaterniond(start) * so3_exp(rate * kDuration_s), {0, 0, 0})};
  const EventOptions options = testing::in_nanoseconds();
  const Events events = testing::record(scene, Spline::interpolate(poses), camera, options).events;
  const auto log_intensity = [&](int x, int y, double t_s) {
    const Eigen::Vector3d ray = start * (so3_exp(rate * t_s) * camera.ray({x, y}));
    return std::log(options.log_eps + seen(map, ray));
  };
  expect_exact(crossings(camera, kDuration_s, options.contrast.on, log_intensity), events, camera);
}

/// Nearest distance [length of the direction] of a ray from the origin to a sphere; 0: none.
double distance_to_sphere(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray,
                          const Eigen::Vector3d& centre, double radius) {
  const Eigen::Vector3d to_origin = origin - centre;
  const double a = ray.squaredNorm();
  const double b = ray.dot(to_origin);
  const double c = to_origin.squaredNorm() - radius * radius;
  const double discriminant = b * b - a * c;
  return discriminant < 0 ? 0 : (-b - std::sqrt(discriminant)) / a;
}

// The mesh lies inside the sphere by at most its sagitta, along the ray by that over the cosine.
TEST(ClosedForm, DepthAndMotionOfASphere) {
  const Eigen::Vector3d centre(0.1, -0.05, 2);
  constexpr double kRadius = 0.6;
  constexpr std::uint32_t kRings = 200;
  const Scene scene = testing::scene_of({testing::ball(centre, kRadius, kRings, ImageF(2, 2, 1))});
  const double half_cell = 0.5 * std::numbers::pi / kRings;
  const double sagitta = 2 * kRadius * (1 - std::cos(half_cell));
  const PinholeCamera camera{80, 60, 90, 95, 40, 30, {}};
  const ImageRenderer renderer(scene, camera, 1);
  const Spline motion = testing::lively_motion(0.2, 1, 1, 3);
  constexpr double kTime_s = 0.07;
  const Rigid3 pose = motion.pose(kTime_s);
  const ImageF depth = renderer.depth({kTime_s, pose});
  const FlowField flow = renderer.flow(motion.state(kTime_s), kTime_s);
  int checked = 0;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector3d ray = pose.rotation() * camera.ray({x, y});
      const double z = distance_to_sphere(pose.translation(), ray, centre, kRadius);
      if (z == 0) continue;
      const Eigen::Vector3d point = pose.translation() + z * ray;
      const double cosine = -(point - centre).dot(ray) / (kRadius * ray.norm());
      if (cosine < 0.3) continue;
      ++checked;
      const double error_m = sagitta / (cosine * ray.norm()) + 1e-6;
      ASSERT_NEAR(static_cast<double>(depth(x, y)), z, error_m);
      const auto image_at = [&](double t_s) -> Eigen::Vector2d {
        return camera.project(motion.pose(t_s).inverse() * point);
      };
      constexpr double kStep_s = 1e-5;
      const Eigen::Vector2d truth =
          (image_at(kTime_s + kStep_s) - image_at(kTime_s - kStep_s)) / (2 * kStep_s);
      const Eigen::Vector2d error(static_cast<double>(flow.u(x, y)) - truth.x(),
                                  static_cast<double>(flow.v(x, y)) - truth.y());
      // What an error of the depth does to the part of the motion that depends on it.
      const double speed_m_s = motion.state(kTime_s).velocity_in_world.norm();
      ASSERT_LT(error.norm(), 2 * 95 * speed_m_s / (z * z) * error_m + 1e-3);
    }
  EXPECT_GT(checked, 500);
}

}  // namespace
}  // namespace saccade
