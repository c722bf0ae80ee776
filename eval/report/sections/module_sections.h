#pragma once

#include <filesystem>
#include <string>

#include "eval/report/run_data.h"

namespace saccade {

/// The parts of a run's section, one for each kind of result, as HTML. A part is empty where the
/// run does not have its kind of result; all but rotation_section() are also empty where the dataset
/// is gone.

/// Scores of depth, a table of its views, estimated depth, truth and errors of the view in the
/// middle and of the worst (thesis figs. 8.9-8.11), the cloud from above, its planes.
[[nodiscard]] std::string depth_section(const RunData& data);

/// Scores of every image; truth, reconstruction, error and standard deviation of the gradient of
/// one view, what is unobserved in colour; the image growing with the events (thesis figs. 8.14 and
/// 8.15).
[[nodiscard]] std::string image_section(const RunData& data);

/// The pictures of growth/, `upscale` screen pixels per pixel; empty where there are none, or so
/// many that they are a film's.
[[nodiscard]] std::string growth_pictures(const std::filesystem::path& folder, int upscale);

/// The keyframes of odometry: a table of when each was made and taken, what it contains and how far
/// the pose jumped; the path from above with the keyframes on it; depth maps and images of at most
/// eight, evenly chosen (thesis figs. 8.18, 8.19).
[[nodiscard]] std::string keyframe_section(const RunData& data);

/// Scores, mosaic, truth and error, the mosaic growing with the events.
[[nodiscard]] std::string mosaic_section(const RunData& data);

/// The angular velocity, axis by axis over time, beside the truth where there is one.
[[nodiscard]] std::string rotation_section(const RunData& data);

/// Events and frames before and after stabilization (thesis figs. 3.2 and 3.3).
[[nodiscard]] std::string stabilization_section(const RunData& data);

/// Stages of a reconstruction, where the run kept their images: Poisson's equation on true gradients
/// (thesis fig. 6.1), depth warped to another view (fig. 6.2).
[[nodiscard]] std::string reconstruction_stage_section(const RunData& data);

/// A short film as `saccade render` makes it, small and inside the page, which a reader starts; its
/// middle stands there until then and on paper. Empty also for a failed run or one with too little
/// for a film. Throws InputError as render() does, without ffmpeg above all.
[[nodiscard]] std::string film_section(const RunData& data);

}  // namespace saccade
