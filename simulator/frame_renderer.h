#pragma once

#include <span>
#include <vector>

#include "core/image.h"
#include "simulator/camera_recording.h"
#include "simulator/sensor/image_renderer.h"

namespace saccade {

/// Renders frames in the colours that `frames.colour` asks for.
class FrameRenderer {
 public:
  /// What `recording` refers to outlives it.
  explicit FrameRenderer(const CameraRecording& recording);

  /// The luminance, depth and motion.
  [[nodiscard]] const ImageRenderer& grey() const { return grey_; }

  /// As ImageRenderer has it: one plane, or R, G and B.
  [[nodiscard]] std::vector<ImageF> radiance(std::span<const StampedPose> poses,
                                             double span_s = 0) const;
  [[nodiscard]] std::vector<ImageF> radiance(std::span<const RowExposure> rows) const;

 private:
  FrameOptions::Colour colour_;
  ImageRenderer grey_;
  /// Of R, G and B, or of the parts of Bayer's pattern.
  std::vector<ImageRenderer> channels_;
};

}  // namespace saccade
