#include "eval/picture/overlay/planar_picture.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include <opencv2/imgproc.hpp>

#include "core/check.h"
#include "core/srgb.h"
#include "eval/picture/canvas/canvas.h"

namespace saccade {
namespace {

static_assert(sizeof(Eigen::Array4f) == 4 * sizeof(float));

cv::Mat view_of(Image<Eigen::Array4f>& level) {
  return {level.height(), level.width(), CV_32FC4, level.data()};
}

constexpr int kSamples = 3;  ///< per screen pixel and axis
/// Points with a smaller ratio of depth to distance lie far outside the image and are clipped.
constexpr double kMinDepthRatio = 0.01;

/// The screen pixels that the picture may cover, max() excluded: all where a part of it is beside
/// or behind the camera.
Eigen::AlignedBox2i bounding_box(const PlanarPicture& picture, const ScreenView& view,
                                 const ImageRgb8& image) {
  const Rigid3 camera_from_world = view.world_from_camera.inverse();
  Eigen::Array2d least(image.width(), image.height());
  Eigen::Array2d most(0, 0);
  for (const Eigen::Vector3d& corner : picture.corners()) {
    const Eigen::Vector3d in_camera = camera_from_world * corner;
    const double distance = in_camera.norm();
    if (!(in_camera.z() >= kMinDepthRatio * distance && std::isfinite(distance)))
      return {Eigen::Vector2i(0, 0), Eigen::Vector2i(image.width(), image.height())};
    const Eigen::Vector2d screen = view.screen_from_pixel(view.camera.project(in_camera));
    least = least.min(screen.array());
    most = most.max(screen.array());
  }
  const auto clamped = [](double at, int size) {
    return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(size)));
  };
  return {
      Eigen::Vector2i(clamped(least.x() - 1, image.width()),
                      clamped(least.y() - 1, image.height())),
      Eigen::Vector2i(clamped(most.x() + 2, image.width()), clamped(most.y() + 2, image.height()))};
}

/// Samples the picture at pixels of the camera.
class PictureSampler {
 public:
  PictureSampler(const PlanarPicture& picture, const Eigen::Matrix3d& plane_from_pixel,
                 double step_px)
      : texels_(picture.texels),
        plane_from_pixel_(plane_from_pixel),
        texels_per_m_(picture.texels.width() / picture.width_m),
        step_px_(step_px) {}

  /// 1 / depth of the plane; not above 0 where the pixel's ray does not meet it.
  [[nodiscard]] double inverse_depth(const Eigen::Vector2d& pixel) const {
    return plane_from_pixel_.row(2).dot(pixel.homogeneous());
  }

  /// Transparent outside the picture.
  [[nodiscard]] Eigen::Array4f operator()(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector3d scaled = plane_from_pixel_ * pixel.homogeneous();
    if (!(scaled.z() > 0)) return Eigen::Array4f::Zero();
    const Eigen::Vector2d texel = scaled.hnormalized() * texels_per_m_;
    const double x = texel.x() + 0.5 * texels_.width();  // from the picture's corner
    const double y = texel.y() + 0.5 * texels_.height();
    if (!(x >= 0 && y >= 0 && x <= texels_.width() && y <= texels_.height()))
      return Eigen::Array4f::Zero();
    // d texel / d pixel, from the quotient rule.
    const Eigen::Matrix2d jacobian = (texels_per_m_ * plane_from_pixel_.topLeftCorner<2, 2>() -
                                      texel * plane_from_pixel_.bottomLeftCorner<1, 2>()) /
                                     scaled.z();
    const double footprint = step_px_ * jacobian.colwise().norm().maxCoeff();
    return texels_.sample(x - 0.5, y - 0.5, footprint);
  }

 private:
  const PicturePyramid& texels_;
  Eigen::Matrix3d plane_from_pixel_;
  double texels_per_m_;
  double step_px_;
};

/// `colour`: linear light times alpha, and alpha.
void blend(Rgb8& pixel, const Eigen::Array4f& colour) {
  for (std::size_t i = 0; i < 3; ++i) {
    const float behind = linear_from_srgb8(pixel[i]);
    pixel[i] = srgb8_from_linear(colour[static_cast<int>(i)] + (1 - colour[3]) * behind);
  }
}

/// The projection of the part of a segment in front of the camera.
std::optional<std::array<Eigen::Vector2d, 2>> project_segment(Eigen::Vector3d a, Eigen::Vector3d b,
                                                              const PinholeCamera& camera) {
  const double near_m = kMinDepthRatio * std::max(a.norm(), b.norm());
  if (!(std::max(a.z(), b.z()) > near_m)) return std::nullopt;
  if (a.z() < near_m) a = b + (a - b) * ((b.z() - near_m) / (b.z() - a.z()));
  if (b.z() < near_m) b = a + (b - a) * ((a.z() - near_m) / (a.z() - b.z()));
  return std::array{camera.project(a), camera.project(b)};
}

}  // namespace

PicturePyramid::PicturePyramid(const ImageRgba8& picture) {
  SACCADE_CHECK(!picture.empty());
  Level full(picture.width(), picture.height());
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const Rgba8& code = picture.pixels()[i];
    const float alpha = static_cast<float>(code[3]) / 255;
    full.pixels()[i] = {alpha * linear_from_srgb8(code[0]), alpha * linear_from_srgb8(code[1]),
                        alpha * linear_from_srgb8(code[2]), alpha};
  }
  levels_.push_back(std::move(full));
  while (levels_.back().width() > 1 || levels_.back().height() > 1) {
    Level half((levels_.back().width() + 1) / 2, (levels_.back().height() + 1) / 2);
    cv::Mat target = view_of(half);
    // Averages over areas: exact for odd sizes too.
    cv::resize(view_of(levels_.back()), target, target.size(), 0, 0, cv::INTER_AREA);
    levels_.push_back(std::move(half));
  }
}

Eigen::Array4f PicturePyramid::sample(double x, double y, double footprint) const {
  const auto coarsest = static_cast<double>(levels_.size() - 1);
  const double level = std::clamp(std::log2(std::max(1.0, footprint)), 0.0, coarsest);
  const auto finer = static_cast<std::size_t>(level);
  const auto weight = static_cast<float>(level - static_cast<double>(finer));
  const Eigen::Array4f fine = sample_level(finer, x, y);
  if (weight == 0) return fine;
  return fine + weight * (sample_level(finer + 1, x, y) - fine);
}

Eigen::Array4f PicturePyramid::sample_level(std::size_t level, double x, double y) const {
  const Level& image = levels_[level];
  const auto scaled = [](double texel, int size, int full) {
    const double at = (texel + 0.5) * size / full - 0.5;
    return std::clamp(at, 0.0, static_cast<double>(size - 1));
  };
  const double u = scaled(x, image.width(), width());
  const double v = scaled(y, image.height(), height());
  const auto x0 = static_cast<int>(u);
  const auto y0 = static_cast<int>(v);
  const int x1 = std::min(x0 + 1, image.width() - 1);
  const int y1 = std::min(y0 + 1, image.height() - 1);
  const auto fx = static_cast<float>(u - x0);
  const auto fy = static_cast<float>(v - y0);
  const Eigen::Array4f top = image(x0, y0) + fx * (image(x1, y0) - image(x0, y0));
  const Eigen::Array4f bottom = image(x0, y1) + fx * (image(x1, y1) - image(x0, y1));
  return top + fy * (bottom - top);
}

Eigen::Matrix3d pixel_from_plane(const PinholeCamera& camera, const Rigid3& camera_from_plane) {
  Eigen::Matrix3d ray_from_plane = camera_from_plane.rotation_matrix();
  ray_from_plane.col(2) = camera_from_plane.translation();
  return camera.matrix() * ray_from_plane;
}

std::array<Eigen::Vector3d, 4> PlanarPicture::corners() const {
  const double x = width_m / 2;
  const double y = height_m() / 2;
  return {world_from_picture * Eigen::Vector3d(-x, -y, 0),
          world_from_picture * Eigen::Vector3d(x, -y, 0),
          world_from_picture * Eigen::Vector3d(x, y, 0),
          world_from_picture * Eigen::Vector3d(-x, y, 0)};
}

bool draw_planar_picture(const PlanarPicture& picture, const ScreenView& view, double opacity,
                         const OcclusionTest& is_occluded, ImageRgb8& image) {
  const Rigid3 camera_from_picture = view.world_from_camera.inverse() * picture.world_from_picture;
  const Eigen::Matrix3d from_plane = pixel_from_plane(view.camera, camera_from_picture);
  // The distance of the camera from the picture's plane [m].
  const Eigen::Vector3d& centre = camera_from_picture.translation();
  const double facing = camera_from_picture.rotation_matrix().col(2).dot(centre);
  if (!(std::abs(facing) > 1e-9 * (centre.norm() + picture.width_m))) return false;

  const double step_px = 1.0 / (kSamples * view.upscale);
  const PictureSampler sampler(picture, from_plane.inverse(), step_px);
  const Eigen::AlignedBox2i box = bounding_box(picture, view, image);
  bool drawn = false;
  for (int y = box.min().y(); y < box.max().y(); ++y)
    for (int x = box.min().x(); x < box.max().x(); ++x) {
      const Eigen::Vector2d corner = Eigen::Vector2d(x, y) / view.upscale - Eigen::Vector2d(.5, .5);
      Eigen::Array4f sum = Eigen::Array4f::Zero();
      for (int i = 0; i < kSamples * kSamples; ++i) {
        const Eigen::Vector2d within(i % kSamples + 0.5, i / kSamples + 0.5);  // NOLINT: whole rows
        sum += sampler(corner + within * step_px);
      }
      if (!(sum[3] > 0)) continue;
      const Eigen::Vector2d middle = corner + Eigen::Vector2d::Constant(0.5 / view.upscale);
      const double inverse_depth = sampler.inverse_depth(middle);
      if (is_occluded && inverse_depth > 0 && is_occluded(view.camera.ray(middle) / inverse_depth))
        continue;
      blend(image(x, y), sum * static_cast<float>(opacity / (kSamples * kSamples)));
      drawn = true;
    }
  return drawn;
}

ImageRgb8 with_outline(ImageRgb8 image, const PlanarPicture& picture, const ScreenView& view,
                       const Rgb8& colour, int thickness) {
  Canvas canvas(std::move(image));
  const Rigid3 camera_from_world = view.world_from_camera.inverse();
  const std::array<Eigen::Vector3d, 4> corners = picture.corners();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto edge =
        project_segment(camera_from_world * corners[i],
                        camera_from_world * corners[(i + 1) % corners.size()], view.camera);
    if (edge)
      canvas.line(view.screen_from_pixel((*edge)[0]), view.screen_from_pixel((*edge)[1]), colour,
                  thickness);
  }
  return canvas.image();
}

}  // namespace saccade
