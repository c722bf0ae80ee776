#include "estimator/tracking/intensity/region_weights.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace saccade {
namespace {

/// A fifteenth of the view, some degrees: objects are as large, and enough pixels fire in it to tell a
/// bad region from bad luck. With 24 px one of 71 worlds more is lost, with 10 px errors grow by 2 %.
constexpr int kSide_px = 16;
constexpr int kColumns_px = 240;  ///< of an image for which that is so
/// A region remembers about so many residuals, of a certainty of 1; in a wider image a pose has more of
/// them in proportion (IntensityTracker takes as many pixels). With 15 and with 200 the errors of
/// 71 worlds grow by 5 and 1 %.
constexpr float kMemory = 50;
/// A region of fewer is taken for a usual one.
constexpr float kLeastCount = 5;
/// Of fewer regions nobody knows what is usual.
constexpr std::size_t kLeastRegions = 8;
/// The mean that this part of the regions stays below is usual: more than half of the image may show
/// something else than the map.
constexpr double kUsual = 0.4;
/// Regions differ by as much without any reason.
constexpr float kSpread = 2;
/// One residual says no more than this of its region.
constexpr float kMostRelative = 4;
/// Where nearly all fits, as with ideal pixels, regions are not judged by their last digits.
constexpr float kFloor = 0.01F;

float memory_of(int width) {
  const float wider = std::max(1.0F, static_cast<float>(width) / kColumns_px);
  return kMemory * wider * std::sqrt(wider);
}

int side_of(int width) { return std::max(kSide_px, kSide_px * width / kColumns_px); }

}  // namespace

RegionWeights::RegionWeights(int width, int height)
    : side_px_(side_of(width)),
      columns_((width + side_px_ - 1) / side_px_),
      rows_((height + side_px_ - 1) / side_px_),
      memory_(memory_of(width)) {
  reset();
}

void RegionWeights::reset() {
  const auto count = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  regions_.assign(count, {});
  weights_.assign(count, 1);
}

std::size_t RegionWeights::region_of(const Eigen::Vector2f& pixel) const {
  const auto part = [&](float at, int count) {
    const float last = static_cast<float>(count * side_px_ - 1);
    return static_cast<std::size_t>(static_cast<int>(std::clamp(at, 0.0F, last)) / side_px_);
  };
  return part(pixel.y(), rows_) * static_cast<std::size_t>(columns_) + part(pixel.x(), columns_);
}

void RegionWeights::add(std::size_t region, float relative, float certainty) {
  regions_[region].new_count += certainty;
  regions_[region].new_sum += certainty * std::min(relative, kMostRelative);
}

void RegionWeights::learn() {
  means_.clear();
  for (Region& region : regions_) {
    const float kept = memory_ / (memory_ + region.new_count);
    region = {kept * region.count + region.new_count, kept * region.sum + region.new_sum, 0, 0};
    if (region.count > kLeastCount) means_.push_back(region.mean());
  }
  if (means_.size() < kLeastRegions) return;
  const auto rank = static_cast<std::ptrdiff_t>(kUsual * static_cast<double>(means_.size()));
  std::nth_element(means_.begin(), means_.begin() + rank, means_.end());
  const float usual = means_[static_cast<std::size_t>(rank)] + kFloor;
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    const bool is_known = regions_[i].count > kLeastCount;
    weights_[i] =
        is_known ? std::min(1.0F, kSpread * usual / std::max(regions_[i].mean(), kFloor)) : 1;
  }
}

}  // namespace saccade
