#include "estimator/tracking/intensity/region_trust.h"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

/// A fifteenth of the view, some degrees: objects are as large, and enough pixels fire in it to tell a
/// bad region from bad luck. With 24 px one world more of 71 is lost, with 10 px errors grow by 2 %.
constexpr int kSide_px = 16;
constexpr int kColumns_px = 240;  ///< of an image for which that is so
/// A region remembers about so many residuals. With 15 and with 200 the errors of 71 worlds are larger
/// by 5 and 1 %.
constexpr float kMemory = 50;
/// With fewer a region is taken for a usual one.
constexpr float kLeastWeight = 5;
/// With fewer regions nobody knows what is usual.
constexpr std::size_t kLeastRegions = 8;
/// The mean residual that this part of the regions stays below is usual: more than half of the image
/// may be of something else.
constexpr double kUsual = 0.4;
/// Regions differ by as much without any reason.
constexpr float kSpread = 2;
/// One residual says no more than this of its region (in units of Cauchy's scale squared).
constexpr float kMostRelative = 4;
/// Where nearly all fits, as on ideal pixels, regions are not judged by their last digits.
constexpr float kFloor = 0.01F;

int side_of(int width) { return std::max(kSide_px, kSide_px * width / kColumns_px); }

}  // namespace

RegionTrust::RegionTrust(int width, int height)
    : side_px_(side_of(width)),
      columns_((width + side_px_ - 1) / side_px_),
      rows_((height + side_px_ - 1) / side_px_) {
  reset();
}

void RegionTrust::reset() {
  const auto count = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  regions_.assign(count, {});
  trust_.assign(count, 1);
}

std::size_t RegionTrust::region_of(const Eigen::Vector2f& pixel) const {
  const auto part = [&](float at, int count) {
    const float last = static_cast<float>(count * side_px_ - 1);
    return static_cast<int>(std::clamp(at, 0.0F, last)) / side_px_;
  };
  return static_cast<std::size_t>(part(pixel.y(), rows_) * columns_ + part(pixel.x(), columns_));
}

void RegionTrust::add(std::size_t region, float relative, float weight) {
  regions_[region].new_weight += weight;
  regions_[region].new_sum += weight * std::min(relative, kMostRelative);
}

void RegionTrust::learn() {
  means_.clear();
  for (Region& region : regions_) {
    const float kept = kMemory / (kMemory + region.new_weight);
    region = {kept * region.weight + region.new_weight, kept * region.sum + region.new_sum, 0, 0};
    if (region.weight > kLeastWeight) means_.push_back(region.mean());
  }
  if (means_.size() < kLeastRegions) return;
  const auto place = static_cast<std::ptrdiff_t>(kUsual * static_cast<double>(means_.size()));
  std::nth_element(means_.begin(), means_.begin() + place, means_.end());
  const float usual = means_[static_cast<std::size_t>(place)] + kFloor;
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    const bool is_known = regions_[i].weight > kLeastWeight;
    trust_[i] =
        is_known ? std::min(1.0F, kSpread * usual / std::max(regions_[i].mean(), kFloor)) : 1;
  }
}

}  // namespace saccade
