#include "estimator/tracking/edge_template.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace saccade {
namespace {

/// A point behind the nearest one of its pixel by more than this factor is hidden by it.
constexpr float kSameSurface = 1.05F;
constexpr float kInvisible = -1;

/// Means of 2 x 2 pixels, as far as `fine` reaches; the rest stays.
void halve(const PaddedImage& fine, PaddedImage& coarse) {
  SACCADE_CHECK(coarse.width == fine.width / 2 && coarse.height == fine.height / 2);
  const int margin = std::min(coarse.margin, fine.margin / 2);
  for (int y = -margin; y < coarse.height + margin; ++y) {
    const float* above = fine.row(2 * y);
    const float* below = fine.row(2 * y + 1);
    float* out = coarse.row(y);
    for (int x = -margin; x < coarse.width + margin; ++x)
      out[x] = 0.25F * (above[2 * x] + above[2 * x + 1] + below[2 * x] + below[2 * x + 1]);
  }
}

}  // namespace

TemplateDrawer::TemplateDrawer(const PinholeCamera& camera, const TemplateOptions& options,
                               const MapPoints& map)
    : TemplateDrawer(camera, options) {
  map_ = &map;
  u_.resize(map.size());
  v_.resize(map.size());
  z_.resize(map.size());
}

TemplateDrawer::TemplateDrawer(const PinholeCamera& camera, const TemplateOptions& options)
    : camera_(camera),
      options_(options),
      map_(nullptr),
      blur_(options.blur_size_px, options.blur_sigma_px) {
  const int margin = blur_.radius() + 1;
  for (PaddedImage* image : {&nearest_, &mask_, &depth_, &blurred_mask_, &blurred_depth_})
    *image = PaddedImage(camera.width, camera.height, margin);
  for (int x = 0; x < camera.width; ++x)
    ray_x_.push_back(static_cast<float>((x - camera.cx) / camera.fx));
  columns_.resize(static_cast<std::size_t>(camera.width));
  points_.reserve(mask_.pixels.size());
}

const std::vector<TemplatePoint>& TemplateDrawer::draw(const Rigid3& camera_from_map) {
  SACCADE_CHECK(map_ != nullptr);
  project(camera_from_map);
  for (PaddedImage* image : {&nearest_, &mask_, &depth_}) image->clear();
  find_nearest();
  if (options_.splat == TemplateOptions::Splat::kNearest) {
    splat_nearest();
  } else {
    splat_bilinear();
  }
  blur_and_collect();
  return points_;
}

const std::vector<TemplatePoint>& TemplateDrawer::draw_halved(const TemplateDrawer& finer) {
  halve(finer.mask_, mask_);
  halve(finer.depth_, depth_);
  blur_and_collect();
  return points_;
}

void TemplateDrawer::blur_and_collect() {
  blur_.apply(mask_, blurred_mask_);
  blur_.apply(depth_, blurred_depth_);
  collect();
}

void TemplateDrawer::project(const Rigid3& camera_from_map) {
  const Eigen::Matrix3f r = camera_from_map.rotation_matrix().cast<float>();
  const Eigen::Vector3f t = camera_from_map.translation().cast<float>();
  const auto fx = static_cast<float>(camera_.fx);
  const auto fy = static_cast<float>(camera_.fy);
  const auto cx = static_cast<float>(camera_.cx + mask_.margin);
  const auto cy = static_cast<float>(camera_.cy + mask_.margin);
  const auto right = static_cast<float>(mask_.stride - 1);
  const auto bottom = static_cast<float>(mask_.rows() - 1);
  const float* x = map_->x.data();
  const float* y = map_->y.data();
  const float* z = map_->z.data();
  for (std::size_t i = 0; i < map_->size(); ++i) {
    const float pz = r(2, 0) * x[i] + r(2, 1) * y[i] + r(2, 2) * z[i] + t.z();
    const float px = r(0, 0) * x[i] + r(0, 1) * y[i] + r(0, 2) * z[i] + t.x();
    const float py = r(1, 0) * x[i] + r(1, 1) * y[i] + r(1, 2) * z[i] + t.y();
    const float u = fx * px / pz + cx;
    const float v = fy * py / pz + cy;
    const bool visible = (pz > 0) & (u >= 0) & (v >= 0) & (u < right) & (v < bottom);
    u_[i] = visible ? u : kInvisible;
    v_[i] = v;
    z_[i] = pz;
  }
}

std::size_t TemplateDrawer::nearest_pixel(std::size_t i) const {
  const int x = static_cast<int>(u_[i] + 0.5F);
  const int y = static_cast<int>(v_[i] + 0.5F);
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(mask_.stride) +
         static_cast<std::size_t>(x);
}

void TemplateDrawer::find_nearest() {
  for (std::size_t i = 0; i < u_.size(); ++i) {
    if (u_[i] == kInvisible) continue;
    float& nearest = nearest_.pixels[nearest_pixel(i)];
    if (nearest == 0 || z_[i] < nearest) nearest = z_[i];
  }
}

void TemplateDrawer::splat_nearest() {
  for (std::size_t i = 0; i < u_.size(); ++i) {
    if (u_[i] == kInvisible) continue;
    const std::size_t pixel = nearest_pixel(i);
    if (z_[i] > nearest_.pixels[pixel]) continue;
    mask_.pixels[pixel] = map_->value[i];
    depth_.pixels[pixel] = map_->value[i] * z_[i];
  }
}

void TemplateDrawer::splat_bilinear() {
  const auto stride = static_cast<std::size_t>(mask_.stride);
  for (std::size_t i = 0; i < u_.size(); ++i) {
    const float u = u_[i];
    const float v = v_[i];
    if (u == kInvisible) continue;
    if (z_[i] > kSameSurface * nearest_.pixels[nearest_pixel(i)]) continue;
    const int x = static_cast<int>(u);
    const int y = static_cast<int>(v);
    const float fx = u - static_cast<float>(x);
    const float fy = v - static_cast<float>(y);
    const float bottom = map_->value[i] * fy;
    const float top = map_->value[i] - bottom;
    const float weights[4] = {top - top * fx, top * fx, bottom - bottom * fx, bottom * fx};
    const std::size_t corner = static_cast<std::size_t>(y) * stride + static_cast<std::size_t>(x);
    float* mask = &mask_.pixels[corner];
    float* depth = &depth_.pixels[corner];
    mask[0] += weights[0];
    mask[1] += weights[1];
    mask[stride] += weights[2];
    mask[stride + 1] += weights[3];
    depth[0] += weights[0] * z_[i];
    depth[1] += weights[1] * z_[i];
    depth[stride] += weights[2] * z_[i];
    depth[stride + 1] += weights[3] * z_[i];
  }
  // Where the map is denser than the view, points pile up: the mask stays a mask.
  for (std::size_t i = 0; i < mask_.pixels.size(); ++i) {
    const float scale = mask_.pixels[i] > 1 ? 1 / mask_.pixels[i] : 1;
    mask_.pixels[i] *= scale;
    depth_.pixels[i] *= scale;
  }
}

void TemplateDrawer::collect() {
  points_.clear();
  lit_pixels_ = 0;
  const auto threshold = static_cast<float>(options_.min_value);
  const auto squared_gradient =
      static_cast<float>(4 * options_.min_gradient_px * options_.min_gradient_px);
  const auto half_fx = static_cast<float>(camera_.fx / 2);
  const auto half_fy = static_cast<float>(camera_.fy / 2);
  for (int y = 1; y + 1 < camera_.height; ++y) {
    const float* above = blurred_mask_.row(y - 1);
    const float* row = blurred_mask_.row(y);
    const float* below = blurred_mask_.row(y + 1);
    const float* depth = blurred_depth_.row(y);
    const auto ray_y = static_cast<float>((y - camera_.cy) / camera_.fy);
    std::size_t count = 0;
    std::size_t lit = 0;
    for (int x = 1; x + 1 < camera_.width; ++x) {
      const float gx = row[x + 1] - row[x - 1];
      const float gy = below[x] - above[x];
      const bool is_lit = row[x] > threshold;
      columns_[count] = x;
      // Without a branch: which pixels pass is hard to predict.
      count += is_lit & (gx * gx + gy * gy >= squared_gradient);
      lit += is_lit;
    }
    lit_pixels_ += lit;
    for (std::size_t i = 0; i < count; ++i) {
      const int x = columns_[i];
      points_.push_back({{ray_x_[static_cast<std::size_t>(x)], ray_y},
                         row[x] / depth[x],
                         row[x],
                         {half_fx * (row[x + 1] - row[x - 1]), half_fy * (below[x] - above[x])}});
    }
  }
}

}  // namespace saccade
