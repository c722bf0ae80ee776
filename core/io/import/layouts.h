#pragma once

#include <filesystem>

#include "core/io/import/public_sequence.h"

namespace saccade {

// One function for each layout: how it is recognised, and how it is opened. `calibration` as of
// open_public_sequence().

/// A sequence of DSEC (Gehrig et al., RA-L 2021): events/left/events.h5,
/// calibration/cam_to_cam.yaml or cam_to_cam.yaml, and disparity/timestamps.txt with
/// disparity/event/*.png where it has them; poses, which DSEC does not publish, from
/// groundtruth.txt (TUM) if somebody put them there. The camera keeps its lens distortion;
/// disparities become depth in its raw view.
[[nodiscard]] bool is_dsec(const std::filesystem::path& folder);
[[nodiscard]] PublicSequence open_dsec(const std::filesystem::path& folder,
                                       const std::filesystem::path& calibration);

/// A sequence of TUM-VIE (Klenk et al., IROS 2021): *events_left.h5 and the
/// camera-calibration*.json that belongs to it; imu_data.txt and, with mocap-imu-calibration*.json,
/// mocap_data.txt where it has them, here or in a folder below. Its fisheye model becomes the
/// nearest radial-tangential one; InputError where that differs by more than a tenth of a pixel.
[[nodiscard]] bool is_tum_vie(const std::filesystem::path& folder);
[[nodiscard]] PublicSequence open_tum_vie(const std::filesystem::path& folder,
                                          const std::filesystem::path& calibration);

/// A recording of iniVation's DV: events, frames, inertial samples [g and deg/s in the file] and
/// triggers. Its clock is that of the file, usually since 1970. The file holds no calibration:
/// without one the focal length is assumed to be the sensor's width, with a notice.
[[nodiscard]] bool is_aedat4(const std::filesystem::path& file);
[[nodiscard]] PublicSequence open_aedat4_sequence(const std::filesystem::path& file,
                                                  const std::filesystem::path& calibration);

/// M3ED (Chaney et al., CVPRW 2023): NAME_data.h5 (/prophesee/left with its calibration, /ovc/imu),
/// with NAME_depth_gt.h5 and NAME_pose_gt.h5 beside it where published; the folder or the file. The
/// world is the camera at the first pose; depth is that of the raw view.
[[nodiscard]] bool is_m3ed(const std::filesystem::path& path);
[[nodiscard]] PublicSequence open_m3ed(const std::filesystem::path& path,
                                       const std::filesystem::path& calibration);

/// MVSEC (Zhu et al., RA-L 2018): NAME_data.hdf5 (/davis/left with events, image_raw and imu), with
/// NAME_gt.hdf5 (pose and depth_image_raw) and a camchain*.yaml beside it or in a folder beside that;
/// the folder or the file. Its equidistant lens becomes the nearest radial-tangential one.
[[nodiscard]] bool is_mvsec(const std::filesystem::path& path);
[[nodiscard]] PublicSequence open_mvsec(const std::filesystem::path& path,
                                        const std::filesystem::path& calibration);

/// VECtor (Gao et al., RA-L 2022): *.synced.left_event.hdf5 and *.synced.gt.txt (TUM, of the body of
/// the motion capture), with left_event_camera_intrinsic_results.yaml,
/// *joint_camera_extrinsic_results.yaml and camera_mocap_extrinsic_results*.yaml there, or in a
/// folder there or beside.
[[nodiscard]] bool is_vector(const std::filesystem::path& folder);
[[nodiscard]] PublicSequence open_vector(const std::filesystem::path& folder,
                                         const std::filesystem::path& calibration);

/// EDS (Hidalgo-Carrio et al., CVPR 2022): events.h5 (columns at its root) and
/// stamped_groundtruth.txt, with a camchain*.yaml or calib*.yaml there or in a folder beside, whose
/// last camera is that of the events. The frames are of another camera and left out.
[[nodiscard]] bool is_eds(const std::filesystem::path& folder);
[[nodiscard]] PublicSequence open_eds(const std::filesystem::path& folder,
                                      const std::filesystem::path& calibration);

/// EuRoC and other folders in ASL's layout: mav0 (or the folder itself) with cam0, and imu0 and
/// state_groundtruth_estimate0 where it has them. No events; poses are those of cam0.
[[nodiscard]] bool is_euroc(const std::filesystem::path& folder);
[[nodiscard]] PublicSequence open_euroc(const std::filesystem::path& folder,
                                        const std::filesystem::path& calibration);

}  // namespace saccade
