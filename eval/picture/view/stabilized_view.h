#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "core/io/dataset/dataset.h"
#include "eval/metrics/sharpness.h"
#include "eval/picture/canvas/contact_sheet.h"
#include "eval/picture/render.h"
#include "eval/picture/view/sensor_view.h"
#include "eval/run_folder.h"

namespace saccade {

/// Event counts on a logarithmic scale up to `max`, which shows edges as well as single events.
[[nodiscard]] ImageRgb8 draw_counts(const ImageF& counts, float max);

/// The radiance of a frame as sRGB, as stabilized frames are written.
[[nodiscard]] ImageRgb8 draw_frame(const ImageF& radiance);

/// Frames and events of a run of `saccade run stabilize` at a time, before and after stabilization;
/// undistorted except the original frame. Holds the events in memory.
class StabilizedView {
 public:
  /// True where the run holds stabilized events or frames.
  [[nodiscard]] static bool is_in(const RunFolder& run);

  /// `events` per picture, those nearest in time; 0: as many as there are pixels. Throws InputError
  /// where a file is malformed.
  StabilizedView(const RunFolder& run, const Dataset& dataset, std::size_t events, int upscale);

  /// Original and stabilized events; empty where the run has none.
  [[nodiscard]] std::vector<CaptionedPicture> events(double t_s) const;
  /// The latest frame at `t_s`, original and stabilized; empty where the run has none.
  [[nodiscard]] std::vector<CaptionedPicture> frames(double t_s) const;

 private:
  const Dataset& dataset_;
  UndistortionTable undistortion_;
  StabilizedRun run_;
  std::vector<StampedFile> files_;
  std::size_t count_;
  int upscale_;
};

/// Draws such a run, see render().
void render_stabilized(const RunFolder& run, const Dataset& dataset, const std::string& title,
                       const RunRecord::Window& span, const std::filesystem::path& output,
                       const RenderOptions& options);

}  // namespace saccade
