#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/rigid3.h"
#include "estimator/tracking/check/pose_evidence.h"
#include "estimator/tracking/map_extraction.h"

namespace saccade {

/// Tells from what was just measured whether a pose can be right, whatever method found it. Map and
/// measurement are drawn into cells of 1/120 of the image's width; that is coarser than
/// any tracker errs, and finer than the poses are displaced that count as lost. What lies on the
/// map's edges by chance, and what a displaced pose explains as well, says nothing. Some thirty
/// microseconds a pose.
class PoseCheck {
 public:
  /// `camera` with its lens.
  explicit PoseCheck(const PinholeCamera& camera);

  /// The map from now on, evenly thinned; copied.
  void set_map(const MapPoints& map);

  /// Takes events as the measurement.
  void measure(std::span<const Event> events);
  /// Takes the steepest pixels of a frame on the undistorted sensor; NaN shows nothing.
  void measure(const ImageF& log_intensity);

  /// Of a pose at the measurement's time.
  [[nodiscard]] PoseEvidence evaluate(const Rigid3& map_from_camera);

  /// Events that a measurement should have: they cover enough of the edges in view while these move
  /// by a pixel or two; fewer than 300 would say little. 1000 of 240 x 180 pixels.
  [[nodiscard]] std::size_t events() const {
    return std::max<std::size_t>(300, has_edge_.size() / 11);
  }

 private:
  static constexpr std::int32_t kNowhere = -1;

  /// Points of the map by coordinate, so that many are projected at a time.
  struct Points {
    std::vector<float> x, y, z;

    [[nodiscard]] std::size_t size() const { return x.size(); }
    void clear();
    void add(float px, float py, float pz);
  };

  [[nodiscard]] std::int32_t cell_at(float x, float y) const;
  void clear_measurement();
  void add_measured(std::int32_t cell);
  /// Writes the cell of each point into cells_, kNowhere for those that are not in view, and its
  /// inverse depth into inverse_depths_.
  void project(const Points& points, const Rigid3& camera_from_map);
  void draw_map(const Rigid3& camera_from_map, PoseEvidence& evidence);
  void compare(PoseEvidence& evidence) const;
  [[nodiscard]] double confirmed_edges(const Rigid3& camera_from_map);

  PinholeCamera camera_;  ///< undistorted
  float cells_per_px_;
  int columns_, rows_;
  std::vector<std::int32_t> cell_of_pixel_;  ///< of the sensor, kNowhere beyond the undistorted one
  Points map_;
  std::vector<std::int32_t> measured_;         ///< cell of every event or pixel
  std::vector<std::uint8_t> has_measurement_;  ///< by cell
  std::vector<std::uint8_t> has_edge_;         ///< by cell, at the pose that is looked at
  std::vector<std::uint16_t> block_of_cell_;
  std::vector<int> cells_of_block_;      ///< number of them
  std::vector<std::uint8_t> is_mapped_;  ///< by block: whether it shows an edge
  Points probes_;                        ///< some of the map's points in view
  std::vector<std::int32_t> cells_;      ///< of project()
  std::vector<float> inverse_depths_;
};

}  // namespace saccade
