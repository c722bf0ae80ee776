#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/imu_sample.h"
#include "core/io/calibration_file.h"
#include "core/io/dataset/dataset_record.h"
#include "core/io/events/event_file.h"
#include "core/io/files/file_list.h"
#include "core/io/images/exr_file.h"
#include "core/srgb.h"
#include "core/trajectory.h"

namespace saccade {

struct DatasetWriterOptions {
  TimestampUnit timestamp_unit = TimestampUnit::kMicroseconds;
  bool events_text = false;          ///< events.txt beside events.h5
  ToneCurve tone{};                  ///< of the 8-bit frames
  std::vector<ChainCamera> chain{};  ///< what camera.yaml holds; empty: the camera alone
};

/// Fills a dataset folder. Every file in it is complete or not there; the folder as a whole gets
/// its final name from the caller (AtomicFolder, ResumableFolder).
class DatasetWriter {
 public:
  /// `folder` is created when it is not there; files of the same names are replaced.
  DatasetWriter(const std::filesystem::path& folder, const PinholeCamera& camera,
                const DatasetWriterOptions& options = {});
  ~DatasetWriter();

  /// Where further files go (objects.txt, imu_groundtruth.txt, cam1/ ...); finish() hashes them
  /// too.
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// Events in order of time, not earlier than those written before. One thread at a time.
  void write_events(std::span<const Event> events);

  /// Frame, depth map and motion field `index` (0, 1, 2 ... in order of time, none left out);
  /// thread-safe for different indices. `radiance` is linear: EXR as it is, and PNG through the
  /// tone curve. `depth` [m], 0 = nothing.
  void write_frame(std::size_t index, double t_s, const ImageF& radiance);
  /// The same of one plane, or of R, G and B, with a PNG of its own: what the camera delivered after
  /// an exposure.
  void write_frame(std::size_t index, double t_s, std::span<const ImageF> exposed,
                   std::span<const ImageF> radiance);
  void write_depth(std::size_t index, double t_s, const ImageF& depth);
  void write_flow(std::size_t index, double t_s, const FlowField& flow);

  /// True when the folder holds the image already, complete and of the camera's size, from a
  /// program that was interrupted: it counts as written. As thread-safe as writing.
  [[nodiscard]] bool take_up_frame(std::size_t index, double t_s);
  [[nodiscard]] bool take_up_depth(std::size_t index, double t_s);
  [[nodiscard]] bool take_up_flow(std::size_t index, double t_s);

  void write_groundtruth(std::span<const StampedPose> world_from_camera);
  void write_imu(std::span<const ImuSample> samples);

  /// Writes the lists, calib.txt, camera.yaml and, last, dataset.yaml. Fills in the record's size,
  /// its name where none is stated (the folder's), unit, counts (those of labels, which others write,
  /// stay as they are), mean depth (unless no depth map
  /// was written), rays per event, hashes and tool version; the rest is the caller's.
  DatasetRecord finish(DatasetRecord record);

 private:
  struct Depths {
    double sum = 0;
    std::uint64_t count = 0;
  };
  void store(std::vector<StampedFile>& list, std::size_t index, double t_s,
             const std::filesystem::path& file);
  void store_depths(std::size_t index, const ImageF& depth);
  [[nodiscard]] bool has_size(const ImageF& image) const;
  [[nodiscard]] std::optional<double> mean_depth() const;

  std::filesystem::path folder_;
  PinholeCamera camera_;
  DatasetWriterOptions options_;
  std::vector<std::unique_ptr<EventWriter>> event_writers_;
  DatasetRecord::Counts counts_;
  std::mutex mutex_;  ///< of the lists below
  std::vector<StampedFile> frames_;
  std::vector<StampedFile> depth_maps_;
  std::vector<StampedFile> flow_maps_;
  std::vector<Depths> depths_;  ///< per depth map, summed in their order
};

}  // namespace saccade
