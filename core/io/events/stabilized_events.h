#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "core/io/tables/h5_table.h"

namespace saccade {

/// places.h5: for each event of a stabilized events.h5, in its order, where it lies to sub-pixel
/// precision and which pixel of the sensor fired it. Groups /places/x, y (f32, undistorted [px]),
/// source_x and source_y (u16).
struct StabilizedCoordinates {
  std::vector<float> x, y;
  std::vector<std::uint16_t> source_x, source_y;

  [[nodiscard]] std::size_t size() const { return x.size(); }
};

/// Writes them part by part. Nothing stands under the final name before close().
class StabilizedCoordinatesWriter {
 public:
  explicit StabilizedCoordinatesWriter(const std::filesystem::path& file);
  void append(const StabilizedCoordinates& places);
  void close() { table_.close(); }

 private:
  H5TableWriter table_;
};

/// `count`: of the events that they belong to. InputError with the place for columns that are
/// missing or of another length.
[[nodiscard]] StabilizedCoordinates read_stabilized_coordinates(const std::filesystem::path& file,
                                                                std::uint64_t count);

/// Consecutive events that were rotated to one orientation: a row of windows.csv.
struct StabilizedWindow {
  double start_s = 0;
  double end_s = 0;  ///< of the events in [start, end)
  double at_s = 0;   ///< when the steady orientation was this one
  Eigen::Quaterniond steady_from_camera = Eigen::Quaterniond::Identity();  ///< at `at_s`
};

/// Comma-separated `start_s, end_s, at_s, qx, qy, qz, qw`. Throws InputError with the file where a
/// column is missing, `file:line` where a cell is no number.
[[nodiscard]] std::vector<StabilizedWindow> read_stabilized_windows(
    const std::filesystem::path& file);
void write_stabilized_windows(const std::filesystem::path& file,
                              std::span<const StabilizedWindow> windows);

}  // namespace saccade
