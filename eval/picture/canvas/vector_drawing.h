#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "eval/picture/canvas/drawing.h"

struct _cairo;  // cairo's state of a drawing

namespace saccade {

/// A drawing for papers: lines stay lines at any size, and its letters are a font that the file
/// holds itself. A pixel of other drawings is 3/4 of a point, so that a chart 400 wide fills 106 mm
/// and its letters have 9 to 10 points.
class VectorDrawing final : public Drawing {
 public:
  /// Whatever fontconfig has for "sans-serif".
  VectorDrawing();

  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Rgb8& colour,
            int thickness = 1) override;
  void polyline(std::span<const Eigen::Vector2d> points, const Rgb8& colour,
                int thickness = 1) override;
  void disc(const Eigen::Vector2d& centre, double radius, const Rgb8& colour) override;
  void rectangle(const Eigen::Vector2d& top_left, const Eigen::Vector2d& size,
                 const Rgb8& colour) override;
  void text(const std::string& text, const Eigen::Vector2d& baseline_left, const Rgb8& colour,
            double height = 9) override;
  [[nodiscard]] double extent_of(const std::string& text, double height) const override;

  /// Writes what was drawn within `width` x `height` as a PDF or SVG, as the file's ending says
  /// (contract: .pdf or .svg). The same drawing gives the same bytes. InputError with the path where
  /// it cannot be written.
  void save(const std::filesystem::path& file, int width, int height) const;

 private:
  struct DestroyContext {
    void operator()(_cairo* context) const;
  };

  std::unique_ptr<_cairo, DestroyContext> letters_;  ///< measures them, and draws nothing
  double capital_height_ = 1;                        ///< of the font at size 1
  std::vector<std::function<void(_cairo*)>> strokes_;
};

}  // namespace saccade
