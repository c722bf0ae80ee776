#include "eval/picture/canvas/canvas.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace saccade {
namespace {

constexpr int kSubPixelBits = 4;
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
/// Height of a capital letter of the font at scale 1 [px].
constexpr double kCapitalHeight = 21;

cv::Mat view_of(ImageRgb8& image) { return {image.height(), image.width(), CV_8UC3, image.data()}; }

cv::Scalar scalar(const Rgb8& colour) {
  return {static_cast<double>(colour[0]), static_cast<double>(colour[1]),
          static_cast<double>(colour[2])};
}

/// OpenCV's fixed-point pixels. Coordinates far outside are clamped so that they fit an int.
cv::Point fixed_point(const Eigen::Vector2d& p) {
  constexpr double kFar = 1e6;
  const auto fixed = [=](double v) {
    const double clamped = std::isfinite(v) ? std::clamp(v, -kFar, kFar) : kFar;
    return static_cast<int>(std::lround(clamped * (1 << kSubPixelBits)));
  };
  return {fixed(p.x()), fixed(p.y())};
}

}  // namespace

Canvas::Canvas(int width, int height, const Rgb8& background) : image_(width, height, background) {}

Canvas::Canvas(ImageRgb8 image) : image_(std::move(image)) {}

void Canvas::paste(const ImageRgb8& picture, int x, int y) {
  const int left = std::max(0, -x);
  const int right = std::min(picture.width(), width() - x);
  for (int row = std::max(0, -y); row < std::min(picture.height(), height() - y); ++row)
    for (int column = left; column < right; ++column)
      image_(x + column, y + row) = picture(column, row);
}

void Canvas::line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Rgb8& colour,
                  int thickness) {
  cv::Mat view = view_of(image_);
  cv::line(view, fixed_point(from), fixed_point(to), scalar(colour), thickness, cv::LINE_AA,
           kSubPixelBits);
}

void Canvas::polyline(std::span<const Eigen::Vector2d> points, const Rgb8& colour, int thickness) {
  std::vector<cv::Point> fixed;
  for (const Eigen::Vector2d& point : points) fixed.push_back(fixed_point(point));
  cv::Mat view = view_of(image_);
  cv::polylines(view, fixed, false, scalar(colour), thickness, cv::LINE_AA, kSubPixelBits);
}

void Canvas::disc(const Eigen::Vector2d& centre, double radius, const Rgb8& colour) {
  cv::Mat view = view_of(image_);
  const int fixed_radius = static_cast<int>(std::lround(radius * (1 << kSubPixelBits)));
  cv::circle(view, fixed_point(centre), fixed_radius, scalar(colour), cv::FILLED, cv::LINE_AA,
             kSubPixelBits);
}

void Canvas::rectangle(const Eigen::Vector2d& top_left, const Eigen::Vector2d& size,
                       const Rgb8& colour) {
  const int width = std::max(1, static_cast<int>(size.x()));
  paste(ImageRgb8(width, static_cast<int>(size.y()), colour), static_cast<int>(top_left.x()),
        static_cast<int>(top_left.y()));
}

void Canvas::text(const std::string& text, const Eigen::Vector2d& baseline_left, const Rgb8& colour,
                  double height) {
  cv::Mat view = view_of(image_);
  const cv::Point at(static_cast<int>(std::lround(baseline_left.x())),
                     static_cast<int>(std::lround(baseline_left.y())));
  cv::putText(view, text, at, kFont, height / kCapitalHeight, scalar(colour),
              std::max(1, static_cast<int>(std::lround(height / 9))), cv::LINE_AA);
}

int Canvas::text_width(const std::string& text, double height) {
  return cv::getTextSize(text, kFont, height / kCapitalHeight, 1, nullptr).width;
}

ImageRgb8 upscale(const ImageRgb8& image, int factor) {
  SACCADE_CHECK(factor >= 1);
  ImageRgb8 result(image.width() * factor, image.height() * factor);
  for (int y = 0; y < result.height(); ++y)
    for (int x = 0; x < result.width(); ++x) result(x, y) = image(x / factor, y / factor);
  return result;
}

}  // namespace saccade
