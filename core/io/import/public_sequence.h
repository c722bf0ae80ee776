#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/imu_sample.h"
#include "core/io/calibration_file.h"
#include "core/io/files/file_list.h"
#include "core/trajectory.h"

namespace saccade {

/// A sequence of a public benchmark as its publisher lays it out, for conversion into a dataset
/// (docs/public_datasets.md). Times are those of the publisher's clock [s].
struct PublicSequence {
  std::string layout;                    ///< "DSEC", "TUM-VIE"
  std::filesystem::path events;          ///< of the left camera (events_h5.h)
  ChainCamera camera;                    ///< that one
  double camera_residual_px = 0;         ///< what its model was changed by at most
  std::vector<StampedPose> groundtruth;  ///< world_from_camera; empty: none
  std::vector<ImuSample> imu;            ///< empty: none
  std::vector<StampedFile> depths;       ///< pictures that load_depth() reads
  /// z depth [m] at the sensor's pixels, 0 = unknown.
  std::function<ImageF(const std::filesystem::path&)> load_depth;
};

/// nullopt where the folder has the layout of neither; InputError where it has, and something is
/// missing or malformed.
[[nodiscard]] std::optional<PublicSequence> open_public_sequence(
    const std::filesystem::path& folder);

/// A sequence of DSEC (Gehrig et al., RA-L 2021): events/left/events.h5,
/// calibration/cam_to_cam.yaml or cam_to_cam.yaml, and disparity/timestamps.txt with
/// disparity/event/*.png where it has them; poses, which DSEC does not publish, from
/// groundtruth.txt (TUM) if somebody put them there. The camera keeps its lens distortion;
/// disparities become depth in its raw view.
[[nodiscard]] PublicSequence open_dsec(const std::filesystem::path& folder);

/// A sequence of TUM-VIE (Klenk et al., IROS 2021): *events_left.h5 and the
/// camera-calibration*.json that belongs to it; imu_data.txt and, with mocap-imu-calibration*.json,
/// mocap_data.txt where it has them, here or in a folder below. Its fisheye model becomes the
/// nearest radial-tangential one; InputError where that differs by more than a tenth of a pixel.
[[nodiscard]] PublicSequence open_tum_vie(const std::filesystem::path& folder);

/// A part of a sequence, in seconds from its first event.
struct ImportWindow {
  double start_s = 0;
  std::optional<double> duration_s;
};

/// Writes it as a dataset folder, a second of events at a time; how many events there are.
std::uint64_t write_as_dataset(const PublicSequence& sequence, const std::filesystem::path& folder,
                               const ImportWindow& window = {});

}  // namespace saccade
