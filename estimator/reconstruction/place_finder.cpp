#include "estimator/reconstruction/place_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.h"

namespace saccade {
namespace {

constexpr float kSameSurface = 1.1F;   ///< ratio of depths
constexpr double kLargestMargin = 64;  ///< of the drawn view [px]

Rigid3 rigid_of(const CameraPose& pose) {
  return {Eigen::Quaterniond(pose.r.cast<double>()), pose.t.cast<double>()};
}

/// The largest (of `sign` -1: smallest) value within `radius`, in x and y.
ImageF extreme_within(const ImageF& image, int radius, float sign) {
  ImageF along_x = image, result(image.width(), image.height());
  const auto more = [sign](float a, float b) { return sign * a > sign * b ? a : b; };
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      for (int u = std::max(x - radius, 0); u <= std::min(x + radius, image.width() - 1); ++u)
        along_x(x, y) = more(along_x(x, y), image(u, y));
  result = along_x;
  for (int y = 0; y < image.height(); ++y)
    for (int v = std::max(y - radius, 0); v <= std::min(y + radius, image.height() - 1); ++v)
      for (int x = 0; x < image.width(); ++x) result(x, y) = more(result(x, y), along_x(x, v));
  return result;
}

}  // namespace

CameraPose inverse_of(const CameraPose& pose) {
  return {pose.r.transpose(), -pose.r.transpose() * pose.t};
}

PlaceFinder::PlaceFinder(const PinholeCamera& camera, const DepthScene& scene,
                         const Rigid3& world_from_reference, const ImageF& reference_inverse_depth,
                         const PlaceOptions& options)
    : camera_(camera.undistorted()),
      view_camera_(camera_),
      scene_(scene),
      world_from_reference_(world_from_reference),
      options_(options),
      fx_(static_cast<float>(camera.fx)),
      fy_(static_cast<float>(camera.fy)),
      cx_(static_cast<float>(camera.cx)),
      cy_(static_cast<float>(camera.cy)),
      same_surface_(static_cast<float>(options.same_surface)),
      rays_(camera.width, camera.height),
      planes_(camera.width, camera.height) {
  const int margin = static_cast<int>(std::ceil(std::min(options.redraw_px, kLargestMargin)));
  margin_ = static_cast<float>(margin);
  view_camera_.width += 2 * margin;
  view_camera_.height += 2 * margin;
  view_camera_.cx += margin;
  view_camera_.cy += margin;
  inverse_depth_ = ImageF(view_camera_.width, view_camera_.height);
  is_near_step_ = ImageU8(view_camera_.width, view_camera_.height);
  const UndistortionTable undistorted(camera);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x)
      rays_(x, y) = camera_.ray(undistorted(x, y).cast<double>()).cast<float>();
  set_planes(reference_inverse_depth);
}

void PlaceFinder::set_planes(const ImageF& inverse_depth) {
  SACCADE_CHECK(inverse_depth.width() == camera_.width && inverse_depth.height() == camera_.height);
  // The slope towards neighbours of the same surface [1/m/px].
  const auto slope = [&](int x, int y, int dx, int dy) {
    const float here = inverse_depth(x, y);
    float sum = 0;
    int count = 0;
    for (const int sign : {-1, 1}) {
      const int u = x + sign * dx, v = y + sign * dy;
      if (u < 0 || v < 0 || u >= camera_.width || v >= camera_.height) continue;
      const float there = inverse_depth(u, v);
      if (!(std::min(here, there) * kSameSurface > std::max(here, there))) continue;
      sum += static_cast<float>(sign) * (there - here);
      ++count;
    }
    return count > 0 ? sum / static_cast<float>(count) : 0;
  };
  for (int y = 0; y < camera_.height; ++y)
    for (int x = 0; x < camera_.width; ++x) {
      const float here = inverse_depth(x, y);
      Plane& plane = planes_(x, y);
      plane = {Eigen::Vector3f::Zero(), here};
      if (!(here > 0)) continue;
      // 1 / z = here + a (u - x) + b (v - y) at pixel (u, v), times z.
      const float a = slope(x, y, 1, 0), b = slope(x, y, 0, 1);
      plane.normal = {a * fx_, b * fy_,
                      here + a * (cx_ - static_cast<float>(x)) + b * (cy_ - static_cast<float>(y))};
    }
}

void PlaceFinder::prepare(const CameraPose& reference_from_camera) {
  if (draws_ > 0 && moved_px(reference_from_camera, view_from_reference_) < options_.redraw_px &&
      parallax_px(reference_from_camera) < options_.parallax_px)
    return;
  const Rigid3 reference_from_view = rigid_of(reference_from_camera);
  scene_.draw((world_from_reference_ * reference_from_view).inverse(), view_camera_,
              inverse_depth_);
  view_from_reference_ = inverse_of(reference_from_camera);
  mark_steps();
  ++draws_;
}

void PlaceFinder::mark_steps() {
  constexpr std::size_t kMost = 64;
  const int radius = std::max(options_.step_margin_px, 1);
  const ImageF high = extreme_within(inverse_depth_, radius, 1);
  ImageF known = inverse_depth_;
  for (float& value : known.pixels())
    if (!(value > 0)) value = std::numeric_limits<float>::infinity();
  const ImageF low = extreme_within(known, radius, -1);
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i < high.size(); ++i) {
    const bool is_step = high.pixels()[i] > kSameSurface * low.pixels()[i];
    is_near_step_.pixels()[i] = is_step && options_.step_margin_px > 0 ? 1 : 0;
    if (is_step) at.push_back(i);
  }
  steps_.clear();
  for (std::size_t k = 0; k < at.size(); k += at.size() / kMost + 1) {
    const auto i = static_cast<int>(at[k]);
    const Eigen::Vector2d pixel(i % view_camera_.width, i / view_camera_.width);
    steps_.push_back(
        {view_camera_.ray(pixel).cast<float>(), 1 / high.pixels()[at[k]], 1 / low.pixels()[at[k]]});
  }
}

double PlaceFinder::parallax_px(const CameraPose& reference_from_camera) const {
  const CameraPose camera_from_reference = inverse_of(reference_from_camera);
  const CameraPose reference_from_view = inverse_of(view_from_reference_);
  const Eigen::Matrix3f r = camera_from_reference.r * reference_from_view.r;
  const Eigen::Vector3f t =
      camera_from_reference.r * reference_from_view.t + camera_from_reference.t;
  float furthest = 0;
  for (const Step& step : steps_) {
    const Eigen::Vector3f ray = r * step.ray;
    const Eigen::Vector3f near = step.near * ray + t, far = step.far * ray + t;
    if (!(near.z() > 0 && far.z() > 0)) return std::numeric_limits<double>::infinity();
    furthest = std::max(furthest, std::hypot(fx_ * (near.x() / near.z() - far.x() / far.z()),
                                             fy_ * (near.y() / near.z() - far.y() / far.z())));
  }
  return static_cast<double>(furthest);
}

double PlaceFinder::moved_px(const CameraPose& reference_from_camera,
                             const CameraPose& earlier_from_reference) const {
  constexpr int kEvery = 31;
  const auto margin = static_cast<int>(margin_);
  double furthest = 0;
  for (int y = kEvery / 2; y < camera_.height; y += kEvery)
    for (int x = kEvery / 2; x < camera_.width; x += kEvery) {
      const float known = inverse_depth_(x + margin, y + margin);
      const float z = known > 0 ? 1 / known : scene_.typical_depth_m;
      const Eigen::Vector3f ray = camera_.ray({x, y}).cast<float>();
      const Eigen::Vector3f p = earlier_from_reference.r * (reference_from_camera.r * (z * ray) +
                                                            reference_from_camera.t) +
                                earlier_from_reference.t;
      if (!(p.z() > 0)) return std::numeric_limits<double>::infinity();
      const Eigen::Vector2d moved = camera_.project(p.cast<double>()) - Eigen::Vector2d(x, y);
      furthest = std::max(furthest, moved.norm());
    }
  return furthest;
}

std::optional<Place> PlaceFinder::find(int x, int y, const CameraPose& reference_from_camera,
                                       const Eigen::Vector2f* earlier) const {
  const Eigen::Vector3f& ray = rays_(x, y);
  const Eigen::Vector3f& from = reference_from_camera.t;
  const Eigen::Vector3f direction = reference_from_camera.r * ray;
  Place place;
  Eigen::Vector3f point;
  if (earlier != nullptr) {
    place.x = earlier->x();
    place.y = earlier->y();
    if (meet_surface(direction, from, place, point) && is_seen(point)) return place;
  }
  if (guess(ray, direction, from, place) && meet_surface(direction, from, place, point) &&
      is_seen(point))
    return place;
  return std::nullopt;
}

bool PlaceFinder::guess(const Eigen::Vector3f& ray, const Eigen::Vector3f& direction,
                        const Eigen::Vector3f& from, Place& place) const {
  // What the drawn view shows at the pixel, then what it shows where that was.
  const int at_pixel = view_index(ray);
  const float there =
      at_pixel < 0 ? 0 : inverse_depth_.pixels()[static_cast<std::size_t>(at_pixel)];
  float z = there > 0 ? 1 / there : scene_.typical_depth_m;
  Eigen::Vector3f point = z * direction + from;
  const Eigen::Vector3f in_view = view_from_reference_.r * point + view_from_reference_.t;
  const int moved = view_index(in_view);
  const float seen = moved < 0 ? 0 : inverse_depth_.pixels()[static_cast<std::size_t>(moved)];
  if (seen > 0) {
    z += 1 / seen - in_view.z();
    point = z * direction + from;
  }
  return point.z() > 0 && project(point, place);
}

bool PlaceFinder::meet_surface(const Eigen::Vector3f& direction, const Eigen::Vector3f& from,
                               Place& place, Eigen::Vector3f& point) const {
  constexpr float kSamePlane = 1e-4F;  // relative difference of depth
  // The plane is that of the pixel the guess fell into, or else of the one that it leads to.
  const Plane* plane = &plane_at(place);
  for (int turn = 0; turn < 2; ++turn) {
    if (!(plane->inverse_depth > 0)) return false;
    const float z = (1 - plane->normal.dot(from)) / plane->normal.dot(direction);
    point = z * direction + from;
    if (!(z > 0 && point.z() > 0) || !project(point, place)) return false;
    plane = &plane_at(place);
    if (std::abs(plane->normal.dot(point) - 1) < kSamePlane) return true;
  }
  return is_same(plane->inverse_depth, place.inverse_depth);
}

bool PlaceFinder::is_seen(const Eigen::Vector3f& point) const {
  const Eigen::Vector3f in_view = view_from_reference_.r * point + view_from_reference_.t;
  const int index = view_index(in_view);
  return index >= 0 && is_near_step_.pixels()[static_cast<std::size_t>(index)] == 0 &&
         is_same(inverse_depth_.pixels()[static_cast<std::size_t>(index)] * in_view.z(), 1);
}

}  // namespace saccade
