#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/io/dataset/dataset.h"
#include "eval/keyframe_history.h"
#include "eval/picture/canvas/contact_sheet.h"
#include "eval/picture/image/path_picture.h"
#include "eval/picture/render.h"
#include "eval/picture/view/sensor_view.h"
#include "eval/run_folder.h"

namespace saccade {

/// The state of an odometry run at a time, in four pictures of the same size. Holds the events of a
/// time span in memory.
class OdometryView {
 public:
  /// `loaded`: the time span that is drawn. `run` has poses. All must outlive this.
  OdometryView(const RunFolder& run, const Dataset& dataset, const KeyframeHistory& history,
               const RunRecord::Window& loaded, const SensorViewStyle& style);

  /// The current map over the events around `t_s`, seen from the estimated pose; the depth of the
  /// current keyframe; its image, where the run made one; the trajectory until `t_s` from above,
  /// with the keyframes (dots), the errors at `t_s` and their means until then.
  [[nodiscard]] std::vector<CaptionedPicture> pictures(double t_s) const;

 private:
  [[nodiscard]] CaptionedPicture path(double t_s) const;

  const RunFolder& run_;
  Similarity truth_from_estimate_;
  const KeyframeHistory& history_;
  SensorView sensor_;
  int upscale_;
  DepthRange range_;  ///< of all keyframes, so that colours are comparable
  ErrorSeries errors_;
  TopDownPath path_;
};

/// Draws such a run, see render(). `run` has poses.
void render_odometry(const RunFolder& run, const Dataset& dataset, const KeyframeHistory& history,
                     const std::string& title, const RunRecord::Window& span,
                     const std::filesystem::path& output, const RenderOptions& options);

}  // namespace saccade
