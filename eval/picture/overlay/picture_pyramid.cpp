#include "eval/picture/overlay/picture_pyramid.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "core/check.h"
#include "core/srgb.h"

namespace saccade {
namespace {

static_assert(sizeof(Eigen::Array4f) == 4 * sizeof(float));

cv::Mat view_of(Image<Eigen::Array4f>& level) {
  return {level.height(), level.width(), CV_32FC4, level.data()};
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

}  // namespace saccade
