#include "tests/support/planar_world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/random.h"

namespace saccade::testing {
namespace {

constexpr float kBackground = -1;

/// Box filter of 3 x 3 texels, so that edges span a pixel or two instead of none.
ImageF soften(const ImageF& image) {
  ImageF out = image;
  for (int y = 1; y + 1 < image.height(); ++y)
    for (int x = 1; x + 1 < image.width(); ++x) {
      float sum = 0;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) sum += image(x + dx, y + dy);
      out(x, y) = sum / 9;
    }
  return out;
}

/// Linear interpolation of the crossings between two samples of one pixel.
void fire(Events& events, int x, int y, float& reference, float before, float after, double t0_s,
          double t1_s, float contrast) {
  while (std::abs(after - reference) >= contrast) {
    const int polarity = after > reference ? 1 : -1;
    reference += static_cast<float>(polarity) * contrast;
    const double fraction = static_cast<double>((reference - before) / (after - before));
    events.push_back({ns_from_seconds(t0_s + (t1_s - t0_s) * fraction),
                      static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                      static_cast<std::int8_t>(polarity)});
  }
}

}  // namespace

PlanarWorld::PlanarWorld(PinholeCamera camera, std::vector<TexturedPlane> planes)
    : camera_(camera), planes_(std::move(planes)) {}

PlanarWorld::View PlanarWorld::view(const Rigid3& world_from_camera) const {
  View view{ImageF(camera_.width, camera_.height, kBackground),
            ImageF(camera_.width, camera_.height)};
  const Eigen::Matrix3d rotation = world_from_camera.rotation_matrix();
  for (const TexturedPlane& plane : planes_) {
    const Eigen::Vector3d normal = plane.edge_u.cross(plane.edge_v);
    const Eigen::Vector3d to_corner = plane.corner - world_from_camera.translation();
    const Eigen::Vector3d u = plane.edge_u / plane.edge_u.squaredNorm();
    const Eigen::Vector3d v = plane.edge_v / plane.edge_v.squaredNorm();
    for (int y = 0; y < camera_.height; ++y)
      for (int x = 0; x < camera_.width; ++x) {
        const Eigen::Vector3d ray = rotation * camera_.ray({x, y});
        const double z = normal.dot(to_corner) / normal.dot(ray);
        float& nearest = view.depth(x, y);
        if (!(z > 0) || (nearest > 0 && z > static_cast<double>(nearest))) continue;
        const Eigen::Vector3d on_plane = ray * z - to_corner;
        const double s = u.dot(on_plane);
        const double t = v.dot(on_plane);
        if (s < 0 || t < 0 || s > 1 || t > 1) continue;
        nearest = static_cast<float>(z);
        view.log_intensity(x, y) =
            static_cast<float>(sample(plane.log_intensity, s * (plane.log_intensity.width() - 1),
                                      t * (plane.log_intensity.height() - 1)));
      }
  }
  return view;
}

ImageF PlanarWorld::log_intensity(const Rigid3& world_from_camera) const {
  return view(world_from_camera).log_intensity;
}

ImageF PlanarWorld::depth(const Rigid3& world_from_camera) const {
  return view(world_from_camera).depth;
}

Events PlanarWorld::simulate(const Motion& world_from_camera, double start_s, double end_s,
                             double step_s, double contrast) const {
  const int steps = static_cast<int>(std::ceil((end_s - start_s) / step_s));
  ImageF before = log_intensity(world_from_camera(start_s));
  ImageF reference = before;
  Events events;
  for (int i = 1; i <= steps; ++i) {
    const double t0 = start_s + (end_s - start_s) * (i - 1) / steps;
    const double t1 = start_s + (end_s - start_s) * i / steps;
    ImageF after = log_intensity(world_from_camera(t1));
    const auto first = static_cast<std::ptrdiff_t>(events.size());
    for (int y = 0; y < camera_.height; ++y)
      for (int x = 0; x < camera_.width; ++x)
        fire(events, x, y, reference(x, y), before(x, y), after(x, y), t0, t1,
             static_cast<float>(contrast));
    std::sort(events.begin() + first, events.end(), EventOrder{});
    before = std::move(after);
  }
  return events;
}

ImageF patch_texture(int width, int height, std::uint64_t seed) {
  const Random random(seed);
  ImageF image(width, height, -1.5F);
  constexpr int kPatches = 260;
  for (std::uint64_t i = 0; i < kPatches; ++i) {
    // Large patches first, so that small ones stay visible.
    const double size = 0.3 * std::exp(-3.0 * static_cast<double>(i) / kPatches) * height;
    const double cx = random.uniform(i, 0) * width;
    const double cy = random.uniform(i, 1) * height;
    const double angle = random.uniform(i, 2) * 3.14159;
    const float value = static_cast<float>(-3 + 3 * random.uniform(i, 3));
    const double aspect = 0.3 + 0.7 * random.uniform(i, 4);
    const int reach = static_cast<int>(size) + 1;
    for (int y = std::max(0, static_cast<int>(cy) - reach);
         y < std::min(height, static_cast<int>(cy) + reach); ++y)
      for (int x = std::max(0, static_cast<int>(cx) - reach);
           x < std::min(width, static_cast<int>(cx) + reach); ++x) {
        const double a = (x - cx) * std::cos(angle) + (y - cy) * std::sin(angle);
        const double b = (y - cy) * std::cos(angle) - (x - cx) * std::sin(angle);
        if (std::abs(a) < size / 2 && std::abs(b) < size * aspect / 2) image(x, y) = value;
      }
  }
  return soften(image);
}

PlanarWorld wall_world(int width, int height, double focal_px, double depth_m, int columns,
                       int rows) {
  PinholeCamera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = focal_px;
  camera.cx = (width - 1) / 2.0;
  camera.cy = (height - 1) / 2.0;
  return {camera,
          {{{-2.4, -1.8, depth_m}, {4.8, 0, 0}, {0, 3.6, 0}, patch_texture(columns, rows, 4)}}};
}

PlanarWorld corner_world(int width, int height) {
  PinholeCamera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = 0.83 * width;
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  const int texels = 2 * width;
  return PlanarWorld(
      camera,
      {{{-2.6, -1.6, 1.8}, {2.8, 0, 1.6}, {0, 3.2, 0}, patch_texture(texels, texels, 1)},
       {{0.2, -1.6, 3.4}, {2.4, 0, -1.8}, {0, 3.2, 0}, patch_texture(texels, texels, 2)},
       {{-0.5, -0.2, 1.5}, {0.7, 0, 0.1}, {0, 0.6, 0}, patch_texture(texels / 3, texels / 3, 3)}});
}

Rigid3 corner_glide(double t_s) {
  return {so3_exp({0.1 * t_s, -0.3 * t_s, 0.4 * t_s}), {0.9 * t_s, 0.25 * t_s, 0.1 * t_s}};
}

Rigid3 drifting_glide(double t_s, double true_until_s, double end_s) {
  const double away = std::max(0.0, t_s - true_until_s) / (end_s - true_until_s);
  return corner_glide(t_s) *
         Rigid3::exp(away * (Twist() << 0.016, -0.01, 0.015, 0.003, 0.004, -0.005).finished());
}

Rigid3 corner_motion(double t_s) {
  const double a = 2 * 3.14159265358979 * t_s;
  const Eigen::Vector3d position(0.20 * std::sin(1.3 * a), 0.15 * std::sin(0.9 * a + 0.4) - 0.058,
                                 0.12 * std::sin(1.1 * a));
  const Eigen::Vector3d rotation(0.05 * std::sin(1.2 * a), 0.06 * std::sin(0.8 * a),
                                 0.08 * std::sin(a));
  return {so3_exp(rotation), position};
}

Trajectory trajectory_of(const Motion& world_from_camera, double end_s) {
  std::vector<StampedPose> poses;
  for (int i = 0; i * 1e-3 <= end_s + 1e-9; ++i)
    poses.push_back({i * 1e-3, world_from_camera(i * 1e-3)});
  return Trajectory(poses);
}

}  // namespace saccade::testing
