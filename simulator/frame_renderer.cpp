#include "simulator/frame_renderer.h"

#include "core/check.h"

namespace saccade {
namespace {

/// Puts the pixels of a part of Bayer's pattern in their places.
void scatter(const ImageF& part, const BayerPart& pattern, ImageF& mosaic) {
  for (int y = 0; y < part.height(); ++y)
    for (int x = 0; x < part.width(); ++x)
      mosaic(pattern.x0 + 2 * x, pattern.y0 + 2 * y) = part(x, y);
}

/// The rows of the whole image that a part has.
std::vector<RowExposure> rows_of(std::span<const RowExposure> rows, const BayerPart& part) {
  std::vector<RowExposure> every_second;
  for (std::size_t y = static_cast<std::size_t>(part.y0); y < rows.size(); y += 2)
    every_second.push_back(rows[y]);
  return every_second;
}

}  // namespace

FrameRenderer::FrameRenderer(const CameraRecording& recording)
    : colour_(recording.config.frames.colour),
      grey_(recording.scene, recording.camera, recording.events.samples_per_pixel,
            recording.events.texture_filter) {
  if (colour_ == FrameOptions::Colour::kGrey) return;
  SACCADE_CHECK(recording.colours != nullptr);
  const int rays = recording.events.samples_per_pixel;
  const TextureFilter filter = recording.events.texture_filter;
  if (colour_ == FrameOptions::Colour::kRgb) {
    for (const Scene* scene :
         {&recording.colours->red, &recording.colours->green, &recording.colours->blue})
      channels_.emplace_back(*scene, recording.camera, rays, filter);
  } else {
    for (const BayerPart& part : kBayerParts)
      channels_.emplace_back(recording.colours->of(part.channel), part.of(recording.camera), rays,
                             filter, kBayerPixelSide);
  }
}

std::vector<ImageF> FrameRenderer::radiance(std::span<const StampedPose> poses,
                                            double span_s) const {
  if (colour_ == FrameOptions::Colour::kGrey) return {grey_.radiance(poses, span_s)};
  std::vector<ImageF> planes;
  for (const ImageRenderer& channel : channels_) planes.push_back(channel.radiance(poses, span_s));
  if (colour_ == FrameOptions::Colour::kRgb) return planes;
  ImageF mosaic(grey_.camera().width, grey_.camera().height);
  for (std::size_t k = 0; k < planes.size(); ++k) scatter(planes[k], kBayerParts[k], mosaic);
  return {mosaic};
}

std::vector<ImageF> FrameRenderer::radiance(std::span<const RowExposure> rows) const {
  if (colour_ == FrameOptions::Colour::kGrey) return {grey_.radiance(rows)};
  if (colour_ == FrameOptions::Colour::kRgb) {
    std::vector<ImageF> planes;
    for (const ImageRenderer& channel : channels_) planes.push_back(channel.radiance(rows));
    return planes;
  }
  ImageF mosaic(grey_.camera().width, grey_.camera().height);
  for (std::size_t k = 0; k < channels_.size(); ++k)
    scatter(channels_[k].radiance(rows_of(rows, kBayerParts[k])), kBayerParts[k], mosaic);
  return {mosaic};
}

}  // namespace saccade
