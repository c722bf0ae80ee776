#include "core/depth_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/check.h"

namespace saccade {
namespace {

constexpr float kMaxDepthRatio = 1.1F;  ///< of neighbours on one surface

bool alike(float a, float b, float c) {
  const float low = std::min({a, b, c});
  return low > 0 && std::max({a, b, c}) <= kMaxDepthRatio * low;
}

/// First and last pixel between two sub-pixel bounds.
int first_pixel(float low) {
  return static_cast<int>(std::ceil(std::clamp(low - 1e-3F, 0.0F, 1e6F)));
}
int last_pixel(float high, int size) {
  return static_cast<int>(
      std::floor(std::clamp(high + 1e-3F, -1.0F, static_cast<float>(size - 1))));
}

/// Draws a triangle into a map of inverse depth, which keeps the nearest.
void draw_triangle(const DepthMesh::Vertex& a, const DepthMesh::Vertex& b,
                   const DepthMesh::Vertex& c, ImageF& inverse_depth) {
  if (!(std::min({a.inverse_depth, b.inverse_depth, c.inverse_depth}) > 0)) return;
  const int left = first_pixel(std::min({a.x, b.x, c.x}));
  const int right = last_pixel(std::max({a.x, b.x, c.x}), inverse_depth.width());
  const int top = first_pixel(std::min({a.y, b.y, c.y}));
  const int bottom = last_pixel(std::max({a.y, b.y, c.y}), inverse_depth.height());
  if (left > right || top > bottom) return;
  const float bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
  const float area = bx * cy - by * cx;
  if (std::abs(area) < 1e-6F) return;
  const float scale = 1 / area;
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x <= right; ++x) {
      const float px = static_cast<float>(x) - a.x, py = static_cast<float>(y) - a.y;
      const float s = (px * cy - py * cx) * scale;
      const float t = (bx * py - by * px) * scale;
      // Half a thousandth of room, lest a pixel falls between two triangles.
      if (!(s >= -5e-4F && t >= -5e-4F && s + t <= 1 + 5e-4F)) continue;
      const float inverse = a.inverse_depth + s * (b.inverse_depth - a.inverse_depth) +
                            t * (c.inverse_depth - a.inverse_depth);
      float& pixel = inverse_depth(x, y);
      pixel = std::max(pixel, inverse);
    }
}

}  // namespace

DepthMesh::DepthMesh(const ImageF& depth, const PinholeCamera& camera)
    : width_(depth.width()), height_(depth.height()) {
  SACCADE_CHECK(width_ == camera.width && height_ == camera.height);
  const UndistortionTable undistorted(camera);
  double inverse_sum = 0;
  std::size_t known = 0;
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const float z = depth(x, y);
      if (!(z > 0) || !std::isfinite(z)) {
        points_.emplace_back(0, 0, 0);
        continue;
      }
      points_.emplace_back(z * camera.ray(undistorted(x, y).cast<double>()).cast<float>());
      inverse_sum += 1 / static_cast<double>(z);
      ++known;
    }
  if (known > 0) typical_depth_m_ = static_cast<float>(static_cast<double>(known) / inverse_sum);
  triangles_.resize(points_.size());
  const auto z_at = [&](int x, int y) {
    return points_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(x)]
        .z();
  };
  for (int y = 0; y + 1 < height_; ++y)
    for (int x = 0; x + 1 < width_; ++x) {
      const float b = z_at(x + 1, y);
      const float c = z_at(x, y + 1);
      const int upper = alike(z_at(x, y), b, c) ? 1 : 0;
      const int lower = alike(z_at(x + 1, y + 1), b, c) ? 2 : 0;
      triangles_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                 static_cast<std::size_t>(x)] = static_cast<std::uint8_t>(upper + lower);
    }
}

std::vector<DepthMesh::Vertex> DepthMesh::project(const Rigid3& camera_from_mesh,
                                                  const PinholeCamera& camera) const {
  const Eigen::Matrix3f r = camera_from_mesh.rotation_matrix().cast<float>();
  const Eigen::Vector3f t = camera_from_mesh.translation().cast<float>();
  const auto fx = static_cast<float>(camera.fx);
  const auto fy = static_cast<float>(camera.fy);
  const auto cx = static_cast<float>(camera.cx);
  const auto cy = static_cast<float>(camera.cy);
  std::vector<Vertex> vertices;
  vertices.reserve(points_.size());
  for (const Eigen::Vector3f& point : points_) {
    const Eigen::Vector3f p = r * point + t;
    const bool is_seen = point.z() > 0 && p.z() > 0;
    const float inverse = is_seen ? 1 / p.z() : 0;
    vertices.push_back({fx * p.x() * inverse + cx, fy * p.y() * inverse + cy, inverse});
  }
  return vertices;
}

void DepthMesh::draw(std::span<const Vertex> vertices, ImageF& inverse_depth) const {
  SACCADE_CHECK(vertices.size() == points_.size());
  inverse_depth.fill(0);
  const auto row = static_cast<std::size_t>(width_);
  for (std::size_t i = 0; i + row + 1 < vertices.size(); ++i) {
    if ((triangles_[i] & 1) != 0)
      draw_triangle(vertices[i], vertices[i + 1], vertices[i + row], inverse_depth);
    if ((triangles_[i] & 2) != 0)
      draw_triangle(vertices[i + 1], vertices[i + row + 1], vertices[i + row], inverse_depth);
  }
}

void DepthMesh::draw(const Rigid3& camera_from_mesh, const PinholeCamera& camera,
                     ImageF& inverse_depth) const {
  SACCADE_CHECK(inverse_depth.width() == camera.width && inverse_depth.height() == camera.height);
  draw(project(camera_from_mesh, camera), inverse_depth);
}

}  // namespace saccade
