#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/imu_sample.h"
#include "core/io/dataset/dataset_record.h"
#include "core/io/events/event_file.h"
#include "core/io/events/labels_h5.h"
#include "core/io/files/file_list.h"
#include "core/io/images/exr_file.h"
#include "core/trajectory.h"

namespace saccade {

/// What dataset.yaml states; absent in a plain Event Camera Dataset folder.
struct DatasetFacts {
  std::optional<double> mean_depth_m;  ///< d of dt_rel (thesis 8.1)
  std::optional<double> contrast_on;   ///< [log units]
  std::optional<double> contrast_off;
  double log_eps = 1e-3;  ///< eps of L = ln(eps + I)
  std::string name;       ///< scene or folder name
};

/// Of start_s <= t < end_s; beyond +-9e9 s open.
[[nodiscard]] TimeWindow time_window(double start_s, double end_s);

/// A dataset folder, simulated or recorded: the layout of the Event Camera Dataset (events.txt,
/// groundtruth.txt, calib.txt, images.txt) with or without events.h5, depth maps and dataset.yaml.
/// Opening reads the small tables and checks them; events and images are read on request, so a
/// listed file that is absent is an error only when it is loaded. Everything malformed is an
/// InputError with file and line. The sensor size comes from dataset.yaml, else camera.yaml, else
/// the first image that is there; nothing is guessed from the events.
class Dataset {
 public:
  [[nodiscard]] static Dataset open(const std::filesystem::path& folder);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const PinholeCamera& camera() const { return camera_; }
  [[nodiscard]] const DatasetFacts& facts() const { return facts_; }
  /// World-from-camera poses; empty when the folder holds none.
  [[nodiscard]] const Trajectory& groundtruth() const { return groundtruth_; }
  /// Grey frames and depth maps in order of time. A frame has an 8-bit PNG, a linear EXR, or both.
  [[nodiscard]] const std::vector<StampedFile>& frames() const { return frames_; }
  [[nodiscard]] const std::vector<StampedFile>& depth_maps() const { return depth_maps_; }
  [[nodiscard]] const std::vector<StampedFile>& flow_maps() const { return flow_maps_; }
  /// All of dataset.yaml; nullopt in a plain folder.
  [[nodiscard]] const std::optional<DatasetRecord>& record() const { return record_; }

  /// events.h5 or, without one, events.txt; empty when the folder holds neither.
  [[nodiscard]] const std::filesystem::path& events_file() const { return events_file_; }
  [[nodiscard]] bool has_imu() const;
  /// Folders of a rig's further cameras, cam1, cam2 ..., each a dataset of its own.
  [[nodiscard]] std::vector<std::filesystem::path> further_cameras() const;

  /// Events with start_s <= t < end_s, in EventOrder. Seconds count from the dataset's time zero.
  [[nodiscard]] Events load_events(double start_s = -std::numeric_limits<double>::infinity(),
                                   double end_s = std::numeric_limits<double>::infinity()) const;
  [[nodiscard]] Events load_events(TimeWindow window) const;
  /// The same events block by block, so that memory does not grow with the recording.
  [[nodiscard]] EventStream stream_events(TimeWindow window = {}) const;
  /// Linear radiance of frame `index`: the EXR where there is one, else the PNG sRGB-decoded to [0,
  /// 1].
  [[nodiscard]] ImageF load_frame(std::size_t index) const;
  /// z depth [m] of depth map `index`, 0 = nothing hit.
  [[nodiscard]] ImageF load_depth(std::size_t index) const;
  [[nodiscard]] FlowField load_flow(std::size_t index) const;
  /// Linear radiance in all directions (panorama.exr), the whole sphere of core/panorama.h; empty
  /// where the folder holds none.
  [[nodiscard]] ImageF load_panorama() const;
  [[nodiscard]] bool has_labels() const;
  /// Labels of the events that load_events() gives for the same window.
  [[nodiscard]] EventLabels load_labels(
      double start_s = -std::numeric_limits<double>::infinity(),
      double end_s = std::numeric_limits<double>::infinity()) const;
  [[nodiscard]] std::vector<ImuSample> load_imu() const;
  /// Pose of the IMU in the camera, T_cam_imu of camera.yaml; nullopt where it is not stated.
  [[nodiscard]] std::optional<Rigid3> camera_from_imu() const;
  /// Of simulated datasets: what is behind the readings, and the camera's motion
  /// (imu_groundtruth.txt, twist.txt).
  [[nodiscard]] std::vector<ImuTruth> load_imu_truth() const;
  [[nodiscard]] std::vector<StampedTwist> load_twists() const;
  /// Poses of the moving objects (objects.txt); empty when there are none.
  [[nodiscard]] std::vector<ObjectPose> load_objects() const;

 private:
  void check_events() const;

  std::filesystem::path folder_;
  std::filesystem::path events_file_;
  std::optional<DatasetRecord> record_;
  PinholeCamera camera_;
  DatasetFacts facts_;
  Trajectory groundtruth_;
  std::vector<StampedFile> frames_;
  std::vector<StampedFile> depth_maps_;
  std::vector<StampedFile> flow_maps_;
};

}  // namespace saccade
