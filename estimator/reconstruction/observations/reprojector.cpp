#include "estimator/reconstruction/observations/reprojector.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "core/check.h"

namespace saccade {
namespace {

constexpr float kDiscontinuityRatio = 1.1F;  ///< ratio of depths of neighbours on two surfaces
constexpr int kSearchStride =
    2;  ///< calls in which pixels without a reprojection are searched once
constexpr std::size_t kChunk = 128;       ///< pixels per vectorised block
constexpr double kLargestMargin_px = 64;  ///< of the rendered view

Rigid3 rigid_of(const CameraPose& pose) {
  return {Eigen::Quaterniond(pose.r.cast<double>()), pose.t.cast<double>()};
}

/// Elementwise maximum, or minimum for `sign` -1.
void keep_extreme(float* values, const float* others, int count, float sign) {
  for (int i = 0; i < count; ++i) {
    const float a = sign * values[i], b = sign * others[i];
    values[i] = sign * (a > b ? a : b);
  }
}

/// Maximum (minimum for `sign` -1) over the square of `radius` around each pixel.
ImageF extreme_within(const ImageF& image, int radius, float sign) {
  const int width = image.width(), height = image.height();
  const auto row = [width](auto& of, int y) {
    return of.data() + static_cast<std::ptrdiff_t>(y) * width;
  };
  ImageF along_x = image;
  for (int y = 0; y < height; ++y)
    for (int d = 1; d <= std::min(radius, width - 1); ++d) {
      keep_extreme(row(along_x, y), row(image, y) + d, width - d, sign);
      keep_extreme(row(along_x, y) + d, row(image, y), width - d, sign);
    }
  ImageF result = along_x;
  for (int y = 0; y < height; ++y)
    for (int v = std::max(y - radius, 0); v <= std::min(y + radius, height - 1); ++v)
      keep_extreme(row(result, y), row(along_x, v), width, sign);
  return result;
}

/// 1 or 0: a factor in place of a branch in vectorised loops.
inline float mask(bool condition) { return condition ? 1.0F : 0.0F; }

}  // namespace

CameraPose inverse_of(const CameraPose& pose) {
  return {pose.r.transpose(), -pose.r.transpose() * pose.t};
}

Reprojector::Reprojector(const PinholeCamera& camera, const DepthScene& scene,
                         const Rigid3& world_from_reference, const ImageF& reference_inverse_depth,
                         const ReprojectionOptions& options)
    : camera_(camera.undistorted()),
      view_camera_(camera_),
      scene_(scene),
      world_from_reference_(world_from_reference),
      options_(options),
      fx_(static_cast<float>(camera.fx)),
      fy_(static_cast<float>(camera.fy)),
      cx_(static_cast<float>(camera.cx)),
      cy_(static_cast<float>(camera.cy)),
      rays_(camera.width, camera.height),
      ray_x_(camera.width, camera.height),
      ray_y_(camera.width, camera.height),
      planes_(camera.width, camera.height) {
  const int margin =
      static_cast<int>(std::ceil(std::min(options.redraw_motion_px, kLargestMargin_px)));
  margin_ = static_cast<float>(margin);
  view_camera_.width += 2 * margin;
  view_camera_.height += 2 * margin;
  view_camera_.cx += margin;
  view_camera_.cy += margin;
  const UndistortionTable undistorted(camera);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      rays_(x, y) = camera_.ray(undistorted(x, y).cast<double>()).cast<float>();
      ray_x_(x, y) = rays_(x, y).x();
      ray_y_(x, y) = rays_(x, y).y();
    }
  set_planes(reference_inverse_depth);
}

void Reprojector::set_planes(const ImageF& inverse_depth) {
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
      if (!(std::min(here, there) * kDiscontinuityRatio > std::max(here, there))) continue;
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

const std::shared_ptr<const RenderedSurfaces>& Reprojector::prepare(
    const CameraPose& reference_from_camera) {
  if (surfaces_ &&
      moved_px(reference_from_camera, surfaces_->camera_from_reference) <
          options_.redraw_motion_px &&
      parallax_px(reference_from_camera) < options_.redraw_parallax_px)
    return surfaces_;
  auto surfaces = std::make_shared<RenderedSurfaces>();
  surfaces->inverse_depth = ImageF(view_camera_.width, view_camera_.height);
  const Rigid3 reference_from_view = rigid_of(reference_from_camera);
  scene_.draw((world_from_reference_ * reference_from_view).inverse(), view_camera_,
              surfaces->inverse_depth);
  surfaces->camera_from_reference = inverse_of(reference_from_camera);
  mark_discontinuities(*surfaces);
  ++draws_;
  surfaces_ = std::move(surfaces);
  return surfaces_;
}

void Reprojector::mark_discontinuities(RenderedSurfaces& surfaces) const {
  constexpr std::size_t kMost = 64;
  const int radius = std::max(options_.discontinuity_margin_px, 1);
  const ImageF high = extreme_within(surfaces.inverse_depth, radius, 1);
  ImageF known = surfaces.inverse_depth;
  for (float& value : known.pixels())
    if (!(value > 0)) value = std::numeric_limits<float>::infinity();
  const ImageF low = extreme_within(known, radius, -1);
  surfaces.open_inverse_depth = surfaces.inverse_depth;
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i < high.size(); ++i) {
    const bool is_step = high.pixels()[i] > kDiscontinuityRatio * low.pixels()[i];
    if (!is_step) continue;
    if (options_.discontinuity_margin_px > 0) surfaces.open_inverse_depth.pixels()[i] = 0;
    at.push_back(i);
  }
  for (std::size_t k = 0; k < at.size(); k += at.size() / kMost + 1) {
    const auto i = static_cast<int>(at[k]);
    const Eigen::Vector2d pixel(i % view_camera_.width, i / view_camera_.width);
    surfaces.discontinuities.push_back(
        {view_camera_.ray(pixel).cast<float>(), 1 / high.pixels()[at[k]], 1 / low.pixels()[at[k]]});
  }
}

double Reprojector::parallax_px(const CameraPose& reference_from_camera) const {
  const CameraPose camera_from_reference = inverse_of(reference_from_camera);
  const CameraPose reference_from_view = inverse_of(surfaces_->camera_from_reference);
  const Eigen::Matrix3f r = camera_from_reference.r * reference_from_view.r;
  const Eigen::Vector3f t =
      camera_from_reference.r * reference_from_view.t + camera_from_reference.t;
  float furthest = 0;
  for (const RenderedSurfaces::Discontinuity& d : surfaces_->discontinuities) {
    const Eigen::Vector3f ray = r * d.ray;
    const Eigen::Vector3f near = d.near * ray + t, far = d.far * ray + t;
    if (!(near.z() > 0 && far.z() > 0)) return std::numeric_limits<double>::infinity();
    furthest = std::max(furthest, std::hypot(fx_ * (near.x() / near.z() - far.x() / far.z()),
                                             fy_ * (near.y() / near.z() - far.y() / far.z())));
  }
  return static_cast<double>(furthest);
}

std::vector<Eigen::Vector3f> Reprojector::samples(const CameraPose& reference_from_camera) const {
  constexpr int kEvery = 31;
  const auto margin = static_cast<int>(margin_);
  std::vector<Eigen::Vector3f> points;
  for (int y = kEvery / 2; y < camera_.height; y += kEvery)
    for (int x = kEvery / 2; x < camera_.width; x += kEvery) {
      const float known = surfaces_->inverse_depth(x + margin, y + margin);
      const float z = known > 0 ? 1 / known : scene_.typical_depth_m;
      const Eigen::Vector3f ray = camera_.ray({x, y}).cast<float>();
      points.emplace_back(reference_from_camera.r * (z * ray) + reference_from_camera.t);
    }
  return points;
}

double Reprojector::moved_px(const CameraPose& reference_from_camera,
                             const CameraPose& earlier_from_reference) const {
  return motion(reference_from_camera, earlier_from_reference, earlier_from_reference).length;
}

ImagePath Reprojector::motion(const CameraPose& reference_from_first,
                              const CameraPose& middle_from_reference,
                              const CameraPose& last_from_reference) const {
  const CameraPose first_from_reference = inverse_of(reference_from_first);
  const auto projected = [&](const CameraPose& camera_from_reference,
                             const Eigen::Vector3f& point) {
    const Eigen::Vector3f p = camera_from_reference.r * point + camera_from_reference.t;
    if (!(p.z() > 0))
      return Eigen::Vector2f::Constant(std::numeric_limits<float>::infinity()).eval();
    return Eigen::Vector2f(fx_ * p.x() / p.z(), fy_ * p.y() / p.z());
  };
  float length = 0, bend = 0;
  for (const Eigen::Vector3f& point : samples(reference_from_first)) {
    const Eigen::Vector2f first = projected(first_from_reference, point);
    const Eigen::Vector2f middle = projected(middle_from_reference, point);
    const Eigen::Vector2f last = projected(last_from_reference, point);
    if (!middle.allFinite() || !last.allFinite())
      return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    length = std::max(length, (last - first).norm());
    bend = std::max(bend, (middle - (first + last) / 2).norm());
  }
  return {static_cast<double>(length), static_cast<double>(bend)};
}

void Reprojector::follow(PixelRows rows, int pass, const RenderedSurfaces& surfaces,
                         const CameraPose& reference_from_camera, const ReprojectionField& earlier,
                         ReprojectionField& reprojections) const {
  const auto width = static_cast<std::size_t>(camera_.width);
  const std::size_t end = static_cast<std::size_t>(rows.end) * width;
  std::size_t i = static_cast<std::size_t>(rows.begin) * width;
  for (std::size_t k = i; k < end; k += kChunk)
    follow_chunk(k, std::min(kChunk, end - k), surfaces, reference_from_camera, earlier,
                 reprojections);
  for (int y = rows.begin; y < rows.end; ++y)
    for (int x = 0; x < camera_.width; ++x, ++i) {
      if (reprojections.inverse_depth[i] > 0) continue;
      const bool is_lost = earlier.inverse_depth[i] > 0;
      if (!is_lost && pass > 0 && (x + 3 * y + pass) % kSearchStride != 0) continue;
      const Eigen::Vector2f from(earlier.x[i], earlier.y[i]);
      const auto reprojection =
          find(x, y, surfaces, reference_from_camera, is_lost ? &from : nullptr);
      if (!reprojection) continue;
      reprojections.x[i] = reprojection->x;
      reprojections.y[i] = reprojection->y;
      reprojections.inverse_depth[i] = reprojection->inverse_depth;
    }
}

void Reprojector::follow_chunk(std::size_t first, std::size_t count,
                               const RenderedSurfaces& surfaces,
                               const CameraPose& reference_from_camera,
                               const ReprojectionField& earlier,
                               ReprojectionField& reprojections) const {
  // find() for the plane of the earlier reprojection, in homogeneous coordinates: the point is
  // (px, py, pz) / den. Arithmetic and memory access are in separate loops, so that the former are
  // vectorised.
  const Eigen::Matrix3f& r = reference_from_camera.r;
  const Eigen::Vector3f& t = reference_from_camera.t;
  const Eigen::Matrix3f& rv = surfaces.camera_from_reference.r;
  const Eigen::Vector3f& tv = surfaces.camera_from_reference.t;
  const float r00 = r(0, 0), r01 = r(0, 1), r02 = r(0, 2), r10 = r(1, 0), r11 = r(1, 1),
              r12 = r(1, 2), r20 = r(2, 0), r21 = r(2, 1), r22 = r(2, 2);
  const float v00 = rv(0, 0), v01 = rv(0, 1), v02 = rv(0, 2), v10 = rv(1, 0), v11 = rv(1, 1),
              v12 = rv(1, 2), v20 = rv(2, 0), v21 = rv(2, 1), v22 = rv(2, 2);
  const float tx = t.x(), ty = t.y(), tz = t.z(), wx = tv.x(), wy = tv.y(), wz = tv.z();
  const float fx = fx_, fy = fy_, cx = cx_, cy = cy_, same = static_cast<float>(kSameSurfaceRatio);
  const float vcx = cx_ + margin_ + 0.5F, vcy = cy_ + margin_ + 0.5F;
  const int width = camera_.width, view_width = view_camera_.width;
  const auto most_x = static_cast<float>(width - 1);
  const auto most_y = static_cast<float>(camera_.height - 1);
  const auto most_u = static_cast<float>(view_width);
  const auto most_v = static_cast<float>(view_camera_.height);
  const float* ray_x = ray_x_.data() + first;
  const float* ray_y = ray_y_.data() + first;
  const float* from_x = earlier.x.data() + first;
  const float* from_y = earlier.y.data() + first;
  const float* from_inverse = earlier.inverse_depth.data() + first;
  std::array<int, kChunk> at, at_view;
  std::array<Plane, kChunk> plane;
  std::array<float, kChunk> x, y, inverse, den, depth, is_in, known, rendered;
  for (std::size_t i = 0; i < count; ++i)
    at[i] = nearest_pixel(from_y[i]) * width + nearest_pixel(from_x[i]);
  for (std::size_t i = 0; i < count; ++i) plane[i] = planes_.data()[at[i]];
  for (std::size_t i = 0; i < count; ++i) {
    const float nx = plane[i].normal[0], ny = plane[i].normal[1], nz = plane[i].normal[2];
    const float dx = r00 * ray_x[i] + r01 * ray_y[i] + r02;
    const float dy = r10 * ray_x[i] + r11 * ray_y[i] + r12;
    const float dz = r20 * ray_x[i] + r21 * ray_y[i] + r22;
    const float d = nx * dx + ny * dy + nz * dz;
    const float num = 1 - (nx * tx + ny * ty + nz * tz);
    const float px = tx * d + num * dx, py = ty * d + num * dy, pz = tz * d + num * dz;
    const float over_pz = 1 / pz;
    x[i] = fx * px * over_pz + cx;
    y[i] = fy * py * over_pz + cy;
    inverse[i] = d * over_pz;
    den[i] = d;
    const float is_here = mask(from_inverse[i] > 0) * mask(num > 0) * mask(d > 0) * mask(pz > 0) *
                          mask(x[i] >= 0) * mask(y[i] >= 0) * mask(x[i] <= most_x) *
                          mask(y[i] <= most_y);
    x[i] = is_here > 0 ? x[i] : 0;
    y[i] = is_here > 0 ? y[i] : 0;
    at[i] = nearest_pixel(y[i]) * width + nearest_pixel(x[i]);
    const float qx = v00 * px + v01 * py + v02 * pz + wx * d;
    const float qy = v10 * px + v11 * py + v12 * pz + wy * d;
    const float qz = v20 * px + v21 * py + v22 * pz + wz * d;
    const float over_qz = 1 / qz;
    const float u = fx * qx * over_qz + vcx, v = fy * qy * over_qz + vcy;
    const float is_shown =
        is_here * mask(qz > 0) * mask(u >= 0) * mask(v >= 0) * mask(u < most_u) * mask(v < most_v);
    const float safe_u = is_shown > 0 ? u : 0, safe_v = is_shown > 0 ? v : 0;
    at_view[i] = static_cast<int>(safe_v) * view_width + static_cast<int>(safe_u);
    depth[i] = qz;
    is_in[i] = is_shown;
  }
  for (std::size_t i = 0; i < count; ++i) {
    known[i] = planes_.data()[at[i]].inverse_depth;
    rendered[i] = surfaces.open_inverse_depth.data()[at_view[i]];
  }
  for (std::size_t i = 0; i < count; ++i) {
    const float is_found = is_in[i] * mask(std::abs(known[i] - inverse[i]) <= same * inverse[i]) *
                           mask(std::abs(rendered[i] * depth[i] - den[i]) <= same * den[i]);
    reprojections.x[first + i] = x[i];
    reprojections.y[first + i] = y[i];
    reprojections.inverse_depth[first + i] = is_found > 0 ? inverse[i] : 0;
  }
}

std::optional<Reprojection> Reprojector::find(int x, int y, const RenderedSurfaces& surfaces,
                                              const CameraPose& reference_from_camera,
                                              const Eigen::Vector2f* earlier) const {
  const Eigen::Vector3f& ray = rays_(x, y);
  const Eigen::Vector3f& from = reference_from_camera.t;
  const Eigen::Vector3f direction = reference_from_camera.r * ray;
  Reprojection reprojection;
  Eigen::Vector3f point;
  if (earlier != nullptr) {
    reprojection.x = earlier->x();
    reprojection.y = earlier->y();
    if (intersect_surface(direction, from, reprojection, point) && is_visible(surfaces, point))
      return reprojection;
  }
  if (guess(ray, surfaces, direction, from, reprojection) &&
      intersect_surface(direction, from, reprojection, point) && is_visible(surfaces, point))
    return reprojection;
  return std::nullopt;
}

bool Reprojector::guess(const Eigen::Vector3f& ray, const RenderedSurfaces& surfaces,
                        const Eigen::Vector3f& direction, const Eigen::Vector3f& from,
                        Reprojection& reprojection) const {
  // The rendered depth at the pixel, then the rendered depth at the projection of that point.
  const int at_pixel = view_index(ray);
  const float there =
      at_pixel < 0 ? 0 : surfaces.inverse_depth.pixels()[static_cast<std::size_t>(at_pixel)];
  float z = there > 0 ? 1 / there : scene_.typical_depth_m;
  Eigen::Vector3f point = z * direction + from;
  const CameraPose& view_from_reference = surfaces.camera_from_reference;
  const Eigen::Vector3f in_view = view_from_reference.r * point + view_from_reference.t;
  const int moved = view_index(in_view);
  const float rendered =
      moved < 0 ? 0 : surfaces.inverse_depth.pixels()[static_cast<std::size_t>(moved)];
  if (rendered > 0) {
    z += 1 / rendered - in_view.z();
    point = z * direction + from;
  }
  return point.z() > 0 && project(point, reprojection);
}

bool Reprojector::intersect_surface(const Eigen::Vector3f& direction, const Eigen::Vector3f& from,
                                    Reprojection& reprojection, Eigen::Vector3f& point) const {
  constexpr float kSamePlane = 1e-4F;  // relative difference of depth
  // The plane of the guess's pixel, or else that of the pixel to which it leads.
  const Plane* plane = &plane_at(reprojection);
  for (int i = 0; i < 2; ++i) {
    if (!(plane->inverse_depth > 0)) return false;
    const float z = (1 - plane->normal.dot(from)) / plane->normal.dot(direction);
    point = z * direction + from;
    if (!(z > 0 && point.z() > 0) || !project(point, reprojection)) return false;
    plane = &plane_at(reprojection);
    if (std::abs(plane->normal.dot(point) - 1) < kSamePlane) return true;
  }
  return is_same_surface(plane->inverse_depth, reprojection.inverse_depth);
}

bool Reprojector::is_visible(const RenderedSurfaces& surfaces, const Eigen::Vector3f& point) const {
  const CameraPose& view_from_reference = surfaces.camera_from_reference;
  const Eigen::Vector3f in_view = view_from_reference.r * point + view_from_reference.t;
  const int index = view_index(in_view);
  return index >= 0 &&
         is_same_surface(
             surfaces.open_inverse_depth.pixels()[static_cast<std::size_t>(index)] * in_view.z(),
             1);
}

}  // namespace saccade
