#include "core/io/images/webp_file.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/check.h"

namespace saccade {

std::string encode_webp(const ImageRgb8& image) {
  SACCADE_CHECK(!image.empty() && std::max(image.width(), image.height()) <= kMostWebpSide);
  constexpr int kLossless = 101;  // a quality above 100
  const cv::Mat rgb(image.height(), image.width(), CV_8UC3, const_cast<Rgb8*>(image.data()));
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  std::vector<unsigned char> bytes;
  SACCADE_CHECK(cv::imencode(".webp", bgr, bytes, {cv::IMWRITE_WEBP_QUALITY, kLossless}));
  return {bytes.begin(), bytes.end()};
}

}  // namespace saccade
