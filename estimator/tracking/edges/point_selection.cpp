#include "estimator/tracking/edges/point_selection.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

namespace saccade {

PointSelector::PointSelector(const SelectionOptions& options, const PinholeCamera& camera)
    : options_(options), camera_(camera) {
  const auto pixels =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  if (options.kind == SelectionOptions::Kind::kSemiDense ||
      options.kind == SelectionOptions::Kind::kSparsePatches) {
    chosen_.reserve(pixels);
    steepness_.reserve(pixels);
    sorted_.reserve(pixels);
  }
  if (options.kind == SelectionOptions::Kind::kSparsePatches) in_patch_.resize(pixels);
}

std::span<const TemplatePoint> PointSelector::select(std::span<const TemplatePoint> points) {
  switch (options_.kind) {
    case SelectionOptions::Kind::kRandom:
    case SelectionOptions::Kind::kDense:
      return points;
    case SelectionOptions::Kind::kSemiDense:
      select_steepest(points);
      break;
    case SelectionOptions::Kind::kSparsePatches:
      select_patches(points);
      break;
  }
  return chosen_;
}

float PointSelector::steepness(const TemplatePoint& point) const {
  const float gx = point.slope.x() / static_cast<float>(camera_.fx);
  const float gy = point.slope.y() / static_cast<float>(camera_.fy);
  return gx * gx + gy * gy;
}

std::size_t PointSelector::pixel_of(const TemplatePoint& point) const {
  const auto x = std::lround(static_cast<double>(point.ray.x()) * camera_.fx + camera_.cx);
  const auto y = std::lround(static_cast<double>(point.ray.y()) * camera_.fy + camera_.cy);
  return static_cast<std::size_t>(y * camera_.width + x);
}

void PointSelector::select_steepest(std::span<const TemplatePoint> points) {
  chosen_.clear();
  if (points.empty()) return;
  steepness_.clear();
  for (const TemplatePoint& point : points) steepness_.push_back(steepness(point));
  const double wanted = options_.steepest_fraction * static_cast<double>(points.size());
  const std::size_t count =
      std::clamp<std::size_t>(static_cast<std::size_t>(wanted), 1, points.size());
  sorted_ = steepness_;
  const auto last = sorted_.begin() + static_cast<std::ptrdiff_t>(count - 1);
  std::nth_element(sorted_.begin(), last, sorted_.end(), std::greater<>());
  for (std::size_t i = 0; i < points.size(); ++i)
    if (steepness_[i] >= *last) chosen_.push_back(points[i]);
}

void PointSelector::select_patches(std::span<const TemplatePoint> points) {
  const auto cell = static_cast<std::size_t>(options_.cell_px);
  const auto width = static_cast<std::size_t>(camera_.width);
  const std::size_t columns = (width + cell - 1) / cell;
  const std::size_t rows = (static_cast<std::size_t>(camera_.height) + cell - 1) / cell;
  steepest_of_cell_.assign(columns * rows, nullptr);
  for (const TemplatePoint& point : points) {
    const std::size_t pixel = pixel_of(point);
    const TemplatePoint*& best =
        steepest_of_cell_[pixel / width / cell * columns + pixel % width / cell];
    if (best == nullptr || steepness(point) > steepness(*best)) best = &point;
  }
  std::fill(in_patch_.begin(), in_patch_.end(), std::uint8_t{0});
  for (const TemplatePoint* best : steepest_of_cell_)
    if (best != nullptr) mark_patch(pixel_of(*best));
  chosen_.clear();
  for (const TemplatePoint& point : points)
    if (in_patch_[pixel_of(point)] != 0) chosen_.push_back(point);
}

void PointSelector::mark_patch(std::size_t centre) {
  const int size = options_.patch_px;
  const int left = static_cast<int>(centre) % camera_.width - size / 2;
  const int top = static_cast<int>(centre) / camera_.width - size / 2;
  for (int y = std::max(top, 0); y < std::min(top + size, camera_.height); ++y)
    for (int x = std::max(left, 0); x < std::min(left + size, camera_.width); ++x)
      in_patch_[static_cast<std::size_t>(y * camera_.width + x)] = 1;
}

}  // namespace saccade
