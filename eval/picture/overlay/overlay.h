#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "core/io/dataset.h"
#include "core/rigid3.h"
#include "core/trajectory.h"
#include "eval/picture/canvas/colour.h"
#include "eval/picture/overlay/planar_picture.h"
#include "eval/picture/canvas/contact_sheet.h"
#include "eval/run_folder.h"

namespace saccade {

/// A picture at a fixed place in the world, drawn over what the camera saw (thesis fig. 8.8).
struct OverlayOptions {
  std::filesystem::path picture;  ///< PNG, JPEG ...; its alpha counts
  /// nullopt: before the camera at `at_s`, facing it, 3 % nearer than the 2nd percentile of the
  /// depths there, so that the picture hangs just in front of the scene.
  std::optional<Rigid3> world_from_picture = std::nullopt;
  /// > 0; nullopt: a quarter of the view's width as seen from the camera at `at_s`.
  std::optional<double> width_m = std::nullopt;
  std::optional<double> at_s = std::nullopt;  ///< nullopt: the begin of the part that is shown
  bool truth = false;   ///< outline where the true pose sees the picture; of runs only
  bool on_top = false;  ///< also where the depth maps see something nearer
};

/// Draws the picture from the poses of a run or, without a run, of the ground truth.
class Overlay {
 public:
  /// `run` may be null; both must outlive this. `map_in_world`: the points that tell how far the
  /// scene is; without any, the depth maps do. Throws InputError where there are no poses to draw
  /// from, no depth to choose a place by, no truth where it is asked for, or no such picture.
  Overlay(const OverlayOptions& options, const Dataset& dataset, const RunFolder* run,
          std::span<const Eigen::Vector3f> map_in_world, double start_s);

  /// `drawn` of the moment `t_s` through the camera without distortion, `upscale` screen pixels per
  /// sensor pixel, with the picture in it; the caption says whose pose it is. Where the run states
  /// that it was lost, or has no pose younger than 20 ms, the picture is faint in a red frame.
  [[nodiscard]] CaptionedPicture over(CaptionedPicture drawn, double t_s, int upscale,
                                      const Theme& theme) const;

  [[nodiscard]] const PlanarPicture& picture() const { return picture_; }

 private:
  [[nodiscard]] bool is_lost(double t_s) const;
  [[nodiscard]] OcclusionTest occlusion_at(double t_s) const;

  const Dataset& dataset_;
  const RunFolder* run_;
  OverlayOptions options_;
  PinholeCamera camera_;  ///< undistorted
  PlanarPicture picture_;
};

}  // namespace saccade
