#include "estimator/reconstruction/place_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace saccade {
namespace {

constexpr float kSameSurface = 1.1F;  ///< ratio of depths

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
                         const Rigid3& world_from_reference, double redraw_px, int step_margin_px)
    : camera_(camera.undistorted()),
      undistorted_(camera),
      scene_(scene),
      world_from_reference_(world_from_reference),
      redraw_px_(redraw_px),
      step_margin_px_(step_margin_px),
      fx_(static_cast<float>(camera.fx)),
      fy_(static_cast<float>(camera.fy)),
      cx_(static_cast<float>(camera.cx)),
      cy_(static_cast<float>(camera.cy)),
      inverse_depth_(camera.width, camera.height),
      is_near_step_(camera.width, camera.height) {}

void PlaceFinder::prepare(const CameraPose& reference_from_camera) {
  if (draws_ > 0 && moved_px(reference_from_camera, view_from_reference_) < redraw_px_) return;
  const Rigid3 reference_from_view = rigid_of(reference_from_camera);
  scene_.draw((world_from_reference_ * reference_from_view).inverse(), camera_, inverse_depth_);
  view_from_reference_ = inverse_of(reference_from_camera);
  if (step_margin_px_ > 0) mark_steps();
  ++draws_;
}

void PlaceFinder::mark_steps() {
  const ImageF high = extreme_within(inverse_depth_, step_margin_px_, 1);
  ImageF known = inverse_depth_;
  for (float& value : known.pixels())
    if (!(value > 0)) value = std::numeric_limits<float>::infinity();
  const ImageF low = extreme_within(known, step_margin_px_, -1);
  for (std::size_t i = 0; i < high.size(); ++i)
    is_near_step_.pixels()[i] = high.pixels()[i] > kSameSurface * low.pixels()[i] ? 1 : 0;
}

double PlaceFinder::moved_px(const CameraPose& reference_from_camera,
                             const CameraPose& earlier_from_reference) const {
  constexpr int kEvery = 31;
  double furthest = 0;
  for (int y = kEvery / 2; y < camera_.height; y += kEvery)
    for (int x = kEvery / 2; x < camera_.width; x += kEvery) {
      const float known = inverse_depth_(x, y);
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

std::optional<Place> PlaceFinder::find(int x, int y,
                                       const CameraPose& reference_from_camera) const {
  const Eigen::Vector2f& pixel = undistorted_(x, y);
  const Eigen::Vector3f ray((pixel.x() - cx_) / fx_, (pixel.y() - cy_) / fy_, 1);
  const float guess = look_up(pixel.x(), pixel.y());
  float z = guess > 0 ? 1 / guess : scene_.typical_depth_m;
  const Eigen::Vector3f direction = reference_from_camera.r * ray;
  // The view was drawn from a few pixels away: the depth is read where its point lies in the view.
  const Eigen::Vector3f in_view =
      view_from_reference_.r * (z * direction + reference_from_camera.t) + view_from_reference_.t;
  if (!(in_view.z() > 0)) return std::nullopt;
  const float scale = 1 / in_view.z();
  const float u = fx_ * in_view.x() * scale + cx_;
  const float v = fy_ * in_view.y() * scale + cy_;
  const float seen = look_up(u, v);
  if (!(seen > 0)) return std::nullopt;
  // look_up() found (u, v) within half a pixel of the view.
  if (is_near_step_(std::clamp(static_cast<int>(u + 0.5F), 0, camera_.width - 1),
                    std::clamp(static_cast<int>(v + 0.5F), 0, camera_.height - 1)) != 0)
    return std::nullopt;
  z += 1 / seen - in_view.z();
  const Eigen::Vector3f point = z * direction + reference_from_camera.t;
  if (!(z > 0 && point.z() > 0)) return std::nullopt;
  const float inverse = 1 / point.z();
  return Place{fx_ * point.x() * inverse + cx_, fy_ * point.y() * inverse + cy_, inverse};
}

float PlaceFinder::look_up(float x, float y) const {
  if (!(x > -0.5F && y > -0.5F && x < static_cast<float>(camera_.width) - 0.5F &&
        y < static_cast<float>(camera_.height) - 0.5F))
    return 0;
  const float u = std::clamp(x, 0.0F, static_cast<float>(camera_.width - 1));
  const float v = std::clamp(y, 0.0F, static_cast<float>(camera_.height - 1));
  const BilinearCell<float> c(u, v, camera_.width, camera_.height);
  const float* row = &inverse_depth_(c.x0, c.y0);
  const float* below = row + camera_.width;
  const float low = std::min(std::min(row[0], row[1]), std::min(below[0], below[1]));
  const float high = std::max(std::max(row[0], row[1]), std::max(below[0], below[1]));
  if (low > 0 && high < kSameSurface * low) {
    const float top = row[0] + c.fx * (row[1] - row[0]);
    const float bottom = below[0] + c.fx * (below[1] - below[0]);
    return top + c.fy * (bottom - top);
  }
  const float nearest = inverse_depth_(c.x0 + (c.fx > 0.5F ? 1 : 0), c.y0 + (c.fy > 0.5F ? 1 : 0));
  return nearest > 0 ? nearest : high;
}

}  // namespace saccade
