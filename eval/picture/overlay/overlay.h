#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "core/io/dataset/dataset.h"
#include "core/rigid3.h"
#include "core/trajectory.h"
#include "eval/metrics/trajectory/align.h"
#include "eval/picture/canvas/colour.h"
#include "eval/picture/canvas/contact_sheet.h"
#include "eval/picture/overlay/planar_picture.h"
#include "eval/run_folder.h"

namespace saccade {

/// A picture at a fixed pose in the world, drawn over events and frames (thesis fig. 8.8). The world of
/// a run that was given no pose is its own, and lengths are in its units.
struct OverlayOptions {
  std::filesystem::path picture;  ///< PNG, JPEG ...; with its alpha channel
  /// nullopt: in front of the camera at `at_s`, facing it, 3 % nearer than the 2nd percentile of
  /// the depths there: just in front of the scene.
  std::optional<Rigid3> world_from_picture = std::nullopt;
  /// > 0; nullopt: a quarter of the view's width as seen from the camera at `at_s`.
  std::optional<double> width_m = std::nullopt;
  std::optional<double> at_s = std::nullopt;  ///< nullopt: the start of the shown part
  bool truth = false;   ///< outline the picture as seen from the true pose; of runs only
  bool on_top = false;  ///< also draw where the depth maps show a nearer surface
};

/// Draws the picture from the poses of a run or, without a run, of the ground truth.
class Overlay {
 public:
  /// `run` may be null; both must outlive this. `map_in_world`: the distance of the scene comes
  /// from these points or, without any, from the depth maps. Throws InputError where there are no
  /// poses, no depth to choose the pose of the picture by, no truth for `options.truth`, or no
  /// picture file. The truth is brought into the world of a run that has its own by the alignment that
  /// its scores take out (with the dataset's mean depth); InputError for `options.truth` where the
  /// run has no pose within the truth to align by.
  Overlay(const OverlayOptions& options, const Dataset& dataset, const RunFolder* run,
          std::span<const Eigen::Vector3f> map_in_world, double start_s);

  /// Adds the picture to `drawn`, an image at time `t_s` without distortion and with `upscale`
  /// screen pixels per sensor pixel; the caption states whose pose was used. Where the run reports
  /// lost track, or has no pose within 20 ms, the picture is faint with a red outline.
  [[nodiscard]] CaptionedPicture over(CaptionedPicture drawn, double t_s, int upscale,
                                      const Theme& theme) const;

  [[nodiscard]] const PlanarPicture& picture() const { return picture_; }

 private:
  [[nodiscard]] bool is_lost(double t_s) const;
  [[nodiscard]] OcclusionTest occlusion_at(double t_s) const;

  const Dataset& dataset_;
  const RunFolder* run_;
  OverlayOptions options_;
  PinholeCamera camera_;       ///< undistorted
  Similarity truth_from_run_;  ///< of a run in a world of its own
  Trajectory truth_in_run_;    ///< the true poses in the world of the picture
  PlanarPicture picture_;
};

}  // namespace saccade
