#include "estimator/depth/sweep/sweep_depth.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/stopwatch.h"
#include "estimator/depth/outlier_removal.h"
#include "estimator/depth/rays/ray_votes.h"

namespace saccade {
namespace {

/// Least parallax between the nearest and the farthest plane; with less, votes cannot tell them
/// apart.
constexpr double kMinParallax_px = 2;

/// Planes, equally spaced in inverse depth, as public mappers have them.
constexpr int kPlanes = 100;
/// Votes by which a pixel must exceed the Gaussian mean of its neighbourhood, where the most votes of
/// the view are 255.
constexpr double kThreshold = 6;

/// Side of the Gaussian neighbourhood of the adaptive threshold, and of the median over a point's
/// neighbours; odd.
constexpr int kThresholdSide_px = 5;
constexpr int kMedianSide_px = 5;

/// 1 where the votes exceed the Gaussian mean of their neighbourhood by the threshold.
ImageU8 adaptive_threshold(const ImageF& votes) {
  const float most = *std::max_element(votes.pixels().begin(), votes.pixels().end());
  ImageU8 mask(votes.width(), votes.height());
  if (!(most > 0)) return mask;
  ImageU8 scaled(votes.width(), votes.height());
  for (std::size_t i = 0; i < votes.size(); ++i)
    scaled.pixels()[i] = static_cast<std::uint8_t>(std::lround(255 * votes.pixels()[i] / most));
  const cv::Mat from(votes.height(), votes.width(), CV_8U, scaled.data());
  cv::Mat to(votes.height(), votes.width(), CV_8U, mask.data());
  cv::adaptiveThreshold(from, to, 1, cv::ADAPTIVE_THRESH_GAUSSIAN_C, cv::THRESH_BINARY,
                        kThresholdSide_px, -kThreshold);
  return mask;
}

/// Median of the values under the mask around (x, y), which is one of them.
float masked_median(const ImageF& values, const ImageU8& mask, int x, int y) {
  std::vector<float> near;
  const int reach = kMedianSide_px / 2;
  for (int v = std::max(y - reach, 0); v <= std::min(y + reach, values.height() - 1); ++v)
    for (int u = std::max(x - reach, 0); u <= std::min(x + reach, values.width() - 1); ++u)
      if (mask(u, v) != 0) near.push_back(values(u, v));
  const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
  std::nth_element(near.begin(), middle, near.end());
  return *middle;
}

}  // namespace

SweepDepth::SweepDepth(const DepthLimits& limits, const PinholeCamera& camera)
    : limits_(limits), camera_(camera.undistorted()), undistortion_(camera) {}

double SweepDepth::spacing() const {
  return (limits_.max_inverse() - limits_.min_inverse()) / (kPlanes - 1);
}

DepthResult SweepDepth::estimate(const ViewWindow& window) const {
  double vote_s = 0, select_s = 0;
  DepthResult result;
  Peaks peaks;
  {
    const ScopedTimer clock(vote_s);
    const EventRays rays(window, camera_, undistortion_, 1);
    peaks = has_parallax(rays) ? sweep(rays) : Peaks{};
  }
  {
    const ScopedTimer clock(select_s);
    const auto selected = select(peaks);
    for (const EdgePoint& point : selected) result.candidates.emplace_back(point.x_px, point.y_px);
    result.points = without_outliers(selected, camera_);
  }
  result.stages_s = {{"votes", vote_s}, {"selection", select_s}};
  return result;
}

SweepDepth::Peaks SweepDepth::sweep(const EventRays& rays) const {
  Peaks peaks{ImageF(camera_.width, camera_.height), ImageF(camera_.width, camera_.height)};
  ImageF votes(camera_.width, camera_.height);
  for (int k = 0; k < kPlanes; ++k) {
    const auto rho = static_cast<float>(limits_.min_inverse() + k * spacing());
    votes.fill(0);
    vote_bilinear(rays, 0, rays.size(), rho, votes);
    for (std::size_t i = 0; i < votes.size(); ++i) {
      if (votes.pixels()[i] <= peaks.votes.pixels()[i]) continue;
      peaks.votes.pixels()[i] = votes.pixels()[i];
      peaks.inverse_depth.pixels()[i] = rho;
    }
  }
  return peaks;
}

bool SweepDepth::has_parallax(const EventRays& rays) const {
  float widest = 0;
  for (const RayLine& line : rays.line) widest = std::max(widest, std::hypot(line.bx, line.by));
  return static_cast<double>(widest) * (limits_.max_inverse() - limits_.min_inverse()) >
         kMinParallax_px;
}

std::vector<EdgePoint> SweepDepth::select(const Peaks& peaks) const {
  if (peaks.votes.empty()) return {};
  const ImageU8 mask = adaptive_threshold(peaks.votes);
  const auto sigma = static_cast<float>(spacing() / std::sqrt(12.0));
  std::vector<EdgePoint> points;
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x)
      if (mask(x, y) != 0)
        points.push_back({static_cast<float>(x), static_cast<float>(y),
                          masked_median(peaks.inverse_depth, mask, x, y), sigma});
  return points;
}

}  // namespace saccade
