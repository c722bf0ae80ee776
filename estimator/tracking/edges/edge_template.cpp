#include "estimator/tracking/edges/edge_template.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include "core/check.h"

namespace saccade {
namespace {

/// A point behind the nearest one of its pixel by more than this factor is hidden by it.
constexpr float kHidden = 1.05F;
constexpr std::int32_t kInvisible = -1;

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

/// A camera over a padded image, whose pixels count from the corner of its margin.
struct Projection {
  Eigen::Matrix3f rotation;  ///< camera from map
  Eigen::Vector3f translation;
  float fx, fy, cx, cy;
  float right, bottom;  ///< first position that is outside
  std::int32_t stride;
};

// The arrays of the functions below do not overlap. The compiler believes it of arguments alone,
// and they are vector code only then.

/// Position (u, v) and depth z of `count` points, and the pixel nearest to them, or kInvisible.
void project_points(std::size_t count, const float* __restrict x, const float* __restrict y,
                    const float* __restrict z, const Projection& camera, float* __restrict out_u,
                    float* __restrict out_v, float* __restrict out_z,
                    std::int32_t* __restrict out_pixel) {
  const Projection p = camera;
  const Eigen::Matrix3f& r = p.rotation;
  for (std::size_t i = 0; i < count; ++i) {
    const float pz = r(2, 0) * x[i] + r(2, 1) * y[i] + r(2, 2) * z[i] + p.translation.z();
    const float px = r(0, 0) * x[i] + r(0, 1) * y[i] + r(0, 2) * z[i] + p.translation.x();
    const float py = r(1, 0) * x[i] + r(1, 1) * y[i] + r(1, 2) * z[i] + p.translation.y();
    const float u = p.fx * px / pz + p.cx;
    const float v = p.fy * py / pz + p.cy;
    const bool visible = (pz > 0) & (u >= 0) & (v >= 0) & (u < p.right) & (v < p.bottom);
    const float safe_u = visible ? u : 0;
    const float safe_v = visible ? v : 0;
    const auto column = static_cast<std::int32_t>(safe_u + 0.5F);
    const auto row = static_cast<std::int32_t>(safe_v + 0.5F);
    out_u[i] = safe_u;
    out_v[i] = safe_v;
    out_z[i] = pz;
    out_pixel[i] = visible ? row * p.stride + column : kInvisible;
  }
}

/// Mask and mask * depth of `count` pixels. Where the map is denser than the view, points pile up:
/// the mask stays a mask.
void part(std::size_t count, const TemplateDrawer::Splat* __restrict splats, float* __restrict mask,
          float* __restrict depth) {
  for (std::size_t i = 0; i < count; ++i) {
    const float scale = splats[i].mask > 1 ? 1 / splats[i].mask : 1;
    mask[i] = splats[i].mask * scale;
    depth[i] = splats[i].depth * scale;
  }
}

/// Differences across the inner pixels of a row of T, and 1 where a pixel is lit and steep enough
/// for a template point; how many are lit.
std::int32_t test_row(std::int32_t width, const float* __restrict above,
                      const float* __restrict row, const float* __restrict below, float threshold,
                      float squared_gradient, float* __restrict gx, float* __restrict gy,
                      std::uint8_t* __restrict is_point) {
  std::int32_t lit_pixels = 0;
  for (std::int32_t x = 1; x < width - 1; ++x) {
    const float dx = row[x + 1] - row[x - 1];
    const float dy = below[x] - above[x];
    const std::int32_t lit = row[x] > threshold ? 1 : 0;
    const std::int32_t steep = dx * dx + dy * dy >= squared_gradient ? 1 : 0;
    gx[x] = dx;
    gy[x] = dy;
    is_point[x] = static_cast<std::uint8_t>(lit & steep);
    lit_pixels += lit;
  }
  return lit_pixels;
}

/// Flags that are looked at together.
constexpr std::size_t kGroup = 8;

/// For every byte of flags the places of its set bits, lowest first.
constexpr auto kPlaces = [] {
  std::array<std::array<std::uint16_t, kGroup>, 256> places{};
  for (unsigned bits = 0; bits < places.size(); ++bits)
    for (unsigned place = 0, count = 0; place < kGroup; ++place)
      if ((bits >> place & 1U) != 0) places[bits][count++] = static_cast<std::uint16_t>(place);
  return places;
}();

/// Writes the places of the ones among `flags` (each 1 or 0, whole groups) to `places` and returns
/// how many there are. Without a branch, as which pixels pass is hard to predict.
std::size_t list_set(const std::vector<std::uint8_t>& flags, std::vector<std::uint16_t>& places) {
  std::size_t count = 0;
  for (std::size_t first = 0; first < flags.size(); first += kGroup) {
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, &flags[first], sizeof bytes);
    // Moves the lowest bit of byte k to bit k of the highest byte (little endian).
    const std::uint64_t bits = (bytes * 0x0102040810204080U) >> 56;
    const auto base = static_cast<std::uint16_t>(first);
    std::array<std::uint16_t, kGroup> group = kPlaces[bits];
    for (std::uint16_t& place : group) place = static_cast<std::uint16_t>(place + base);
    std::memcpy(&places[count], group.data(), sizeof group);
    count += static_cast<std::size_t>(std::popcount(bits));
  }
  return count;
}

}  // namespace

TemplateDrawer::TemplateDrawer(const PinholeCamera& camera, const TemplateOptions& options,
                               const MapPoints& map)
    : TemplateDrawer(camera, options) {
  set_map(map);
}

void TemplateDrawer::set_map(const MapPoints& map) {
  map_ = &map;
  u_.resize(map.size());
  v_.resize(map.size());
  z_.resize(map.size());
  pixel_.resize(map.size());
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
  const auto width = static_cast<std::size_t>(camera.width);
  // Whole groups, of which the last writes all its places.
  const std::size_t padded = (width + kGroup - 1) / kGroup * kGroup;
  is_point_.resize(padded);
  splats_.resize(mask_.pixels.size());
  for (auto* differences : {&gx_, &gy_}) differences->resize(width);
  columns_.resize(padded + kGroup);
  points_.resize(width * static_cast<std::size_t>(camera.height));
}

std::span<const TemplatePoint> TemplateDrawer::draw(const Rigid3& camera_from_map) {
  SACCADE_CHECK(map_ != nullptr);
  project(camera_from_map);
  nearest_.clear();
  std::fill(splats_.begin(), splats_.end(), Splat{});
  find_nearest();
  if (options_.bilinear) {
    splat_bilinear();
  } else {
    splat_nearest();
  }
  part(splats_.size(), splats_.data(), mask_.pixels.data(), depth_.pixels.data());
  blur_and_collect();
  return {points_.data(), point_count_};
}

std::span<const TemplatePoint> TemplateDrawer::draw_halved(const TemplateDrawer& finer) {
  halve(finer.mask_, mask_);
  halve(finer.depth_, depth_);
  blur_and_collect();
  return {points_.data(), point_count_};
}

void TemplateDrawer::blur_and_collect() {
  blur_.apply(mask_, blurred_mask_);
  blur_.apply(depth_, blurred_depth_);
  collect();
}

void TemplateDrawer::project(const Rigid3& camera_from_map) {
  Projection p;
  p.rotation = camera_from_map.rotation_matrix().cast<float>();
  p.translation = camera_from_map.translation().cast<float>();
  p.fx = static_cast<float>(camera_.fx);
  p.fy = static_cast<float>(camera_.fy);
  p.cx = static_cast<float>(camera_.cx + mask_.margin);
  p.cy = static_cast<float>(camera_.cy + mask_.margin);
  p.right = static_cast<float>(mask_.stride - 1);
  p.bottom = static_cast<float>(mask_.rows() - 1);
  p.stride = mask_.stride;
  project_points(map_->size(), map_->x.data(), map_->y.data(), map_->z.data(), p, u_.data(),
                 v_.data(), z_.data(), pixel_.data());
}

void TemplateDrawer::find_nearest() {
  for (std::size_t i = 0; i < pixel_.size(); ++i) {
    if (pixel_[i] == kInvisible) continue;
    float& nearest = nearest_.pixels[static_cast<std::size_t>(pixel_[i])];
    if (nearest == 0 || z_[i] < nearest) nearest = z_[i];
  }
}

void TemplateDrawer::splat_nearest() {
  for (std::size_t i = 0; i < pixel_.size(); ++i) {
    if (pixel_[i] == kInvisible) continue;
    const auto pixel = static_cast<std::size_t>(pixel_[i]);
    if (z_[i] <= nearest_.pixels[pixel] || !options_.z_test) splats_[pixel] = {1, z_[i]};
  }
}

void TemplateDrawer::splat_bilinear() {
  const auto stride = static_cast<std::size_t>(mask_.stride);
  const float same_surface = options_.z_test ? kHidden : std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < pixel_.size(); ++i) {
    if (pixel_[i] == kInvisible) continue;
    const float z = z_[i];
    if (z > same_surface * nearest_.pixels[static_cast<std::size_t>(pixel_[i])]) continue;
    const int x = static_cast<int>(u_[i]);
    const int y = static_cast<int>(v_[i]);
    const float fx = u_[i] - static_cast<float>(x);
    const float fy = v_[i] - static_cast<float>(y);
    Splat* corner = &splats_[static_cast<std::size_t>(y) * stride + static_cast<std::size_t>(x)];
    corner[0].add((1 - fx) * (1 - fy), z);
    corner[1].add(fx * (1 - fy), z);
    corner[stride].add((1 - fx) * fy, z);
    corner[stride + 1].add(fx * fy, z);
  }
}

std::size_t TemplateDrawer::find_points(int y) {
  const auto squared_gradient =
      static_cast<float>(4 * options_.min_gradient_px * options_.min_gradient_px);
  lit_pixels_ += static_cast<std::size_t>(test_row(
      camera_.width, blurred_mask_.row(y - 1), blurred_mask_.row(y), blurred_mask_.row(y + 1),
      kMinTemplateValue, squared_gradient, gx_.data(), gy_.data(), is_point_.data()));
  return list_set(is_point_, columns_);
}

void TemplateDrawer::collect() {
  lit_pixels_ = 0;
  std::size_t count = 0;
  const auto half_fx = static_cast<float>(camera_.fx / 2);
  const auto half_fy = static_cast<float>(camera_.fy / 2);
  for (int y = 1; y + 1 < camera_.height; ++y) {
    const auto ray_y = static_cast<float>((y - camera_.cy) / camera_.fy);
    const float* value = blurred_mask_.row(y);
    const float* depth = blurred_depth_.row(y);
    const std::size_t found = find_points(y);
    // The inverse depth is that of (4.20).
    for (std::size_t i = 0; i < found; ++i) {
      const std::size_t x = columns_[i];
      points_[count++] = {
          {ray_x_[x], ray_y}, value[x] / depth[x], value[x], {half_fx * gx_[x], half_fy * gy_[x]}};
    }
  }
  point_count_ = count;
}

}  // namespace saccade
