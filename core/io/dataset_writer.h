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
#include "core/io/atomic_file.h"
#include "core/io/dataset_record.h"
#include "core/io/event_file.h"
#include "core/io/exr_file.h"
#include "core/io/file_list.h"
#include "core/trajectory.h"

namespace saccade {

struct DatasetWriterOptions {
  TimestampUnit timestamp_unit = TimestampUnit::kMicroseconds;
  bool events_text = false;  ///< events.txt beside events.h5
};

/// Fills a dataset folder, which appears under its final name when finish() is done; without it
/// nothing is left. An existing dataset of that name is replaced, another folder is an InputError.
class DatasetWriter {
 public:
  DatasetWriter(const std::filesystem::path& folder, const PinholeCamera& camera,
                const DatasetWriterOptions& options = {});
  ~DatasetWriter();

  /// Where further files go (objects.txt, imu_groundtruth.txt, cam1/ ...); finish() hashes them
  /// too.
  [[nodiscard]] const std::filesystem::path& folder() const { return target_.path(); }

  /// Events in order of time, not earlier than those written before. One thread at a time.
  void write_events(std::span<const Event> events);

  /// Frame, depth map and motion field `index` (0, 1, 2 ... in order of time, none left out);
  /// thread-safe for different indices. `radiance` is linear: EXR, and PNG sRGB-encoded. `depth`
  /// [m], 0 = nothing.
  void write_frame(std::size_t index, double t_s, const ImageF& radiance);
  void write_depth(std::size_t index, double t_s, const ImageF& depth);
  void write_flow(std::size_t index, double t_s, const FlowField& flow);

  void write_groundtruth(std::span<const StampedPose> world_from_camera);
  void write_imu(std::span<const ImuSample> samples);

  /// Writes the lists, calib.txt, camera.yaml and dataset.yaml and gives the folder its name. Fills
  /// in the record's size, its name where none is stated (the folder's), unit, counts, mean depth
  /// (unless no depth map was written), rays per event, hashes and tool version; the rest is the
  /// caller's.
  DatasetRecord finish(DatasetRecord record);

 private:
  struct Depths {
    double sum = 0;
    std::uint64_t count = 0;
  };
  void store(std::vector<StampedFile>& list, std::size_t index, double t_s,
             const std::filesystem::path& file);
  [[nodiscard]] std::optional<double> mean_depth() const;

  AtomicFolder target_;
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
