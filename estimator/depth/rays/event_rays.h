#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "estimator/depth/depth_estimator.h"

namespace saccade {

/// x(rho) = a + b rho in the reference view.
struct RayLine {
  float ax, ay;  ///< a [px]
  float bx, by;  ///< b [px m]
};

/// p x'(rho) = qa + qb rho: the direction in which the log intensity increases.
struct RayGradient {
  float qax, qay;  ///< [px/s]
  float qbx, qby;  ///< [px m/s]
};

/// The rays of a window's events as lines in the reference view. An event at pixel u of a camera
/// with centre o and orientation R (both in the reference frame) saw a point of the ray o + l R
/// K^-1 u. Its projection into the reference view is linear in its inverse depth rho:
///   x(rho) = a + b rho,   a = pi(R K^-1 u),   b = K_2 (o_xy - o_z (R K^-1 u)_xy / (R K^-1 u)_z)
/// with K_2 the focal lengths; a is the pixel without the camera's rotation, b the parallax. The
/// pixel's projection moves over the surface with x'(rho) = a' + b' rho, so that an event of
/// polarity p means p x'(rho) . grad L > 0 (2.7).
///
/// Events are sorted by time slice, by polarity within it, and by cell of the sensor, so that those
/// near a given point are found by projecting it into every slice and are contiguous in memory.
class EventRays {
 public:
  static constexpr int kCell_px = 4;
  /// Cells around the sensor, for pixels that undistortion moves outside it.
  static constexpr int kMarginCells = 4;
  /// Cell = (pixel + origin) / kCell_px, rounded down.
  static constexpr float kCellOrigin_px = 0.5F + kMarginCells * kCell_px;

  /// `camera` undistorted. `slices` >= 1 equal parts of the window's time.
  EventRays(const ViewWindow& window, const PinholeCamera& camera,
            const UndistortionTable& undistortion, int slices);

  /// For events that come later by `later_s` than they were taken to: the rays follow their rates, and what is off is a
  /// half of the acceleration times its square, 0.01 px of a fast hand after 1 ms. `window`, with the delay from now on.
  void take_out(double later_s, const ViewWindow& window, const PinholeCamera& camera);

  /// A part of the window's time with the pose in its middle.
  struct TimeSlice {
    Eigen::Matrix3f pixel_from_reference;  ///< K R^T K^-1, homogeneous pixels
    Eigen::Vector3f centre_term;           ///< K R^T o
    Eigen::Vector3f centre;                ///< o [m], reference frame
    Eigen::Matrix3f pixel_rate;            ///< d pixel_from_reference / dt
    Eigen::Vector3f centre_rate;           ///< d centre_term / dt
    float middle_s = 0;                    ///< from the reference time [s]

    /// Homogeneous pixel of the reference view's pixel at inverse depth `rho`; z <= 0 if behind.
    [[nodiscard]] Eigen::Vector3f project(const Eigen::Vector2f& pixel, float rho) const {
      return pixel_from_reference * pixel.homogeneous() - rho * centre_term;
    }
  };

  [[nodiscard]] std::size_t size() const { return line.size(); }
  [[nodiscard]] std::span<const TimeSlice> slices() const { return slices_; }
  [[nodiscard]] int slice_count() const { return static_cast<int>(slices_.size()); }
  [[nodiscard]] float slice_length_s() const {
    return static_cast<float>(seconds_from_ns(slice_ns_));
  }
  /// The slice nearest to the reference time.
  [[nodiscard]] int reference_slice() const;
  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }

  /// Index of the first event of a cell; the next cell of the row begins where it ends.
  [[nodiscard]] std::uint32_t cell_begin(int slice, bool is_on, int column, int row) const {
    return offsets_[index_of(slice, is_on, column, row)];
  }
  /// The cell of an undistorted sensor pixel; pixels outside the grid belong to its border.
  [[nodiscard]] int column_of(float x_px) const;
  [[nodiscard]] int row_of(float y_px) const;
  /// Index of the first event of a slice; of slice_count(), the number of events.
  [[nodiscard]] std::size_t slice_begin(int slice) const {
    return offsets_[index_of(slice, false, 0, 0)];
  }

  std::vector<std::uint32_t> source;  ///< index into the window's events
  std::vector<RayLine> line;
  std::vector<RayGradient> gradient;

 private:
  [[nodiscard]] std::size_t index_of(int slice, bool is_on, int column, int row) const {
    const std::size_t layer = 2 * static_cast<std::size_t>(slice) + (is_on ? 1 : 0);
    return (layer * static_cast<std::size_t>(rows_) + static_cast<std::size_t>(row)) *
               static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  void make_slices(const ViewWindow& window, const PinholeCamera& camera, int count);
  /// Position of each event in sorted order.
  [[nodiscard]] std::vector<std::uint32_t> sort_events(std::span<const Event> events,
                                                       const UndistortionTable& undistortion);

  TimeNs start_ns_ = 0;
  TimeNs slice_ns_ = 1;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<TimeSlice> slices_;
  std::vector<std::uint32_t> offsets_;
};

}  // namespace saccade
