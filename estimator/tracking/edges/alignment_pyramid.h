#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/rigid3.h"
#include "estimator/tracking/edges/edge_template.h"
#include "estimator/tracking/edges/event_frame.h"
#include "estimator/tracking/edges/template_aligner.h"

namespace saccade {

/// The alignment at a half, a quarter ... of the resolution, coarsest first: template and frame are
/// means over 2 x 2 pixels of the level below, so that each level pulls from twice as far away. Its
/// outcome is the first guess of the alignment at full resolution.
class AlignmentPyramid {
 public:
  /// `camera` is undistorted and of full resolution; `align.pyramid_levels` counts it, so that 1
  /// makes no level here. A level below 16 px is left out.
  AlignmentPyramid(const TemplateOptions& templates, const AlignOptions& align,
                   const PinholeCamera& camera);

  /// Takes over the last draw of the full template.
  void set_template(const TemplateDrawer& full);
  /// Arguments as TemplateAligner::align(). Levels that fail change nothing.
  /// Nothing without levels.
  [[nodiscard]] std::optional<Rigid3> approach(const EventFrame& full, const Rigid3& prediction,
                                               const Matrix6& precision, std::uint64_t seed,
                                               std::uint64_t draw);

 private:
  struct Level {
    Level(const TemplateOptions& templates, const AlignOptions& align, const PinholeCamera& camera);
    TemplateDrawer drawer;
    TemplateAligner aligner;
    EventFrame frame;
  };
  std::vector<Level> levels_;  ///< finest first
};

}  // namespace saccade
