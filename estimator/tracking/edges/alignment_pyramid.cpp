#include "estimator/tracking/edges/alignment_pyramid.h"

#include <algorithm>

namespace saccade {
namespace {

constexpr int kSmallest_px = 16;

/// The camera whose pixels are 2 x 2 pixels of this one.
PinholeCamera halved(const PinholeCamera& camera) {
  PinholeCamera half = camera;
  half.width /= 2;
  half.height /= 2;
  half.fx /= 2;
  half.fy /= 2;
  half.cx = (camera.cx - 0.5) / 2;
  half.cy = (camera.cy - 0.5) / 2;
  return half;
}

}  // namespace

AlignmentPyramid::Level::Level(const TemplateOptions& templates, const AlignOptions& align,
                               const PinholeCamera& camera)
    : drawer(camera, templates), aligner(align, camera), frame(camera) {}

AlignmentPyramid::AlignmentPyramid(const TemplateOptions& templates, const AlignOptions& align,
                                   const PinholeCamera& camera) {
  TemplateOptions options = templates;
  PinholeCamera half = camera;
  for (int level = 1; level < align.pyramid_levels; ++level) {
    half = halved(half);
    if (std::min(half.width, half.height) < kSmallest_px) return;
    options.min_gradient_px /= 2;  // thin lines fade when they are averaged
    levels_.emplace_back(options, align, half);
  }
}

void AlignmentPyramid::set_template(const TemplateDrawer& full) {
  const TemplateDrawer* finer = &full;
  for (Level& level : levels_) {
    level.aligner.set_template(level.drawer.draw_halved(*finer));
    finer = &level.drawer;
  }
}

std::optional<Rigid3> AlignmentPyramid::approach(const EventFrame& full, const Rigid3& prediction,
                                                 const Matrix6& precision, std::uint64_t seed,
                                                 std::uint64_t draw) {
  if (levels_.empty()) return std::nullopt;
  const EventFrame* finer = &full;
  for (Level& level : levels_) {
    level.frame.draw_halved(*finer);
    finer = &level.frame;
  }
  Rigid3 guess = prediction;
  for (std::size_t i = levels_.size(); i-- > 0;) {
    Level& level = levels_[i];
    const std::uint64_t level_draw = draw + ((i + 1) << 48);  // samples of its own
    // No brightness measured at the guess: far from the truth its gain is small and the steps,
    // which are divided by it, are too large.
    const AlignResult aligned =
        level.aligner.align(level.frame, prediction, precision, {}, seed, level_draw, guess);
    if (aligned.status == AlignStatus::kOk) guess = aligned.current_from_template;
  }
  return guess;
}

}  // namespace saccade
