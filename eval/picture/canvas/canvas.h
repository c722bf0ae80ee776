#pragma once

#include <span>
#include <string>

#include <Eigen/Core>

#include "core/image.h"
#include "eval/picture/canvas/drawing.h"

namespace saccade {

/// A picture with anti-aliased drawing. Positions in pixels; (0, 0) is the centre of the top-left
/// pixel. What falls outside is clipped.
class Canvas : public Drawing {
 public:
  Canvas(int width, int height, const Rgb8& background);
  explicit Canvas(ImageRgb8 image);

  [[nodiscard]] const ImageRgb8& image() const { return image_; }
  [[nodiscard]] int width() const { return image_.width(); }
  [[nodiscard]] int height() const { return image_.height(); }

  /// Copies `picture` with its top-left pixel at (x, y).
  void paste(const ImageRgb8& picture, int x, int y);
  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Rgb8& colour,
            int thickness = 1) override;
  void polyline(std::span<const Eigen::Vector2d> points, const Rgb8& colour,
                int thickness = 1) override;
  void disc(const Eigen::Vector2d& centre, double radius, const Rgb8& colour) override;
  void rectangle(const Eigen::Vector2d& top_left, const Eigen::Vector2d& size,
                 const Rgb8& colour) override;
  void text(const std::string& text, const Eigen::Vector2d& baseline_left, const Rgb8& colour,
            double height = 9) override;
  [[nodiscard]] double extent_of(const std::string& text, double height) const override {
    return text_width(text, height);
  }
  /// Width of a text [px].
  [[nodiscard]] static int text_width(const std::string& text, double height = 9);

 private:
  ImageRgb8 image_;
};

/// Every pixel becomes a square of `factor` x `factor` pixels; `factor` >= 1.
[[nodiscard]] ImageRgb8 upscale(const ImageRgb8& image, int factor);

}  // namespace saccade
