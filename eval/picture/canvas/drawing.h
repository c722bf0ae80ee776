#pragma once

#include <span>
#include <string>

#include <Eigen/Core>

#include "core/image.h"

namespace saccade {

/// What charts are drawn on: pixels (Canvas) or a page of lines and letters (VectorDrawing). Positions
/// in pixels from the centre of the top-left one; what falls outside is clipped.
class Drawing {
 public:
  Drawing() = default;
  virtual ~Drawing() = default;
  Drawing(const Drawing&) = default;
  Drawing& operator=(const Drawing&) = default;
  Drawing(Drawing&&) = default;
  Drawing& operator=(Drawing&&) = default;

  virtual void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Rgb8& colour,
                    int thickness = 1) = 0;
  virtual void polyline(std::span<const Eigen::Vector2d> points, const Rgb8& colour,
                        int thickness = 1) = 0;
  virtual void disc(const Eigen::Vector2d& centre, double radius, const Rgb8& colour) = 0;
  /// Filled. On pixels the edges are rounded down, and at least a column is filled.
  virtual void rectangle(const Eigen::Vector2d& top_left, const Eigen::Vector2d& size,
                         const Rgb8& colour) = 0;
  /// `baseline_left`: the start of the baseline; `height`: of a capital letter [px].
  virtual void text(const std::string& text, const Eigen::Vector2d& baseline_left,
                    const Rgb8& colour, double height = 9) = 0;
  /// How far text() of the same text reaches [px].
  [[nodiscard]] virtual double extent_of(const std::string& text, double height) const = 0;
};

}  // namespace saccade
