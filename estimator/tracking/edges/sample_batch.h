#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/camera.h"
#include "core/rigid3.h"
#include "estimator/lanes.h"
#include "estimator/tracking/edges/edge_template.h"
#include "estimator/tracking/edges/event_frame.h"
#include "estimator/tracking/robust_loss.h"

namespace saccade {

/// Up to kCapacity samples of a template on their way through one iteration of the aligner,
/// structure of arrays in single precision, so that every step but the two lookups is vector code.
class SampleBatch {
 public:
  static constexpr int kCapacity = 256;
  static constexpr int kColumns = 8;  ///< J (6), T, 1
  using Floats = std::array<float, kCapacity>;

  /// Loads the samples first .. first + count - 1 of `total`. Sample k is uniform in the k-th of
  /// `total` equal runs of the points, so that a draw covers the image evenly, and with as many
  /// samples as points takes each of them once. `key` names the draw; count <= kCapacity.
  void load(std::span<const TemplatePoint> points, int first, int count, int total,
            std::uint32_t key);

  /// Loads these points, each once; at most kCapacity.
  void load_all(std::span<const TemplatePoint> points);

  /// Where the samples fall in the frame: W(u; current_from_template) (4.15). Samples behind the
  /// camera or outside the frame become invisible: they count for nothing below.
  void warp(const PinholeCamera& camera, const EventFrame& frame,
            const Rigid3& current_from_template);

  /// In place of warp(): all samples are visible.
  void show_all();

  /// Bilinear value of the frame (full event = 1), or with `smooth` of its 3 x 3 means, and the
  /// residual I - gain T - offset.
  void compare(const EventFrame& frame, bool smooth, float gain, float offset);

  /// After compare(): weighs every sample by its residual over `sigma` in all that follows, so that
  /// visible() becomes the sum of the weights. A sigma of 0 leaves them alike.
  void weigh(RobustLoss kind, float sigma);

  /// For column_dot_column(): the columns J, T, 1 of the normal equations, with
  ///   J = (a/Z, b/Z, -(a x + b y)/Z, -y (a x + b y) - b, x (a x + b y) + a, b x - a y),
  /// which is grad T times the interaction matrix (4.17, for the point's motion), (a, b) = slope.
  void differentiate();

  [[nodiscard]] std::array<double, kColumns> columns_dot_residual() const;
  [[nodiscard]] double column_dot_column(int a, int b) const;
  [[nodiscard]] double squared_residual() const;
  [[nodiscard]] double visible() const;
  /// Samples where frame and template lie on the same side of their means.
  [[nodiscard]] double agreeing(float mean_value, float mean_frame) const;

 private:
  /// Whole lanes; what is behind the last sample is invisible.
  [[nodiscard]] std::size_t padded() const {
    return padded_to_lanes(static_cast<std::size_t>(count_));
  }
  void gather(std::span<const TemplatePoint> points);
  void read_bilinear(const EventFrame& frame);
  void read_smooth(const EventFrame& frame);
  [[nodiscard]] std::array<Lanes, kColumns> columns_at(std::size_t i) const;

  int count_ = 0;
  alignas(64) Floats ray_x_, ray_y_, inverse_depth_, value_, slope_x_, slope_y_;
  alignas(64) Floats visible_;  ///< 1 or 0; after weigh() the root of the weight
  alignas(64) Floats fraction_x_, fraction_y_;
  alignas(64) std::array<std::int32_t, kCapacity> pixel_;  ///< offset of the upper left neighbour
  alignas(
      64) std::array<std::uint32_t, kCapacity> neighbours_;  ///< the four bytes around the sample
  alignas(64) std::array<std::array<std::uint32_t, kCapacity>, 4> windows_;  ///< 4 x 4 bytes
  alignas(64) Floats frame_value_, residual_;
  alignas(64) std::array<Floats, kColumns> columns_;
};

}  // namespace saccade
