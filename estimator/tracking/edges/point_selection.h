#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/camera.h"
#include "estimator/tracking/edges/edge_template.h"

namespace saccade {

/// Which points of a template an alignment runs over (thesis section 4.3, fig. 4.1).
struct SelectionOptions {
  enum class Kind { kRandom, kDense, kSemiDense, kSparsePatches };

  Kind kind = Kind::kRandom;       ///< random points are drawn afresh per iteration, others fixed
  double steepest_fraction = 0.5;  ///< of kSemiDense: the points with the steepest gradients
  int cell_px = 20;  ///< of kSparsePatches: one patch per cell, some 100 on a 240 x 180 sensor
  int patch_px = 8;  ///< of kSparsePatches: its size, around the cell's steepest point
};

/// Chooses the points. Keeps its buffers, so that a choice allocates nothing.
class PointSelector {
 public:
  PointSelector(const SelectionOptions& options, const PinholeCamera& camera);

  /// The chosen part of `points` (in row-major order, as they come), valid until the next call and
  /// no longer than `points`. kRandom and kDense choose all of them.
  [[nodiscard]] std::span<const TemplatePoint> select(std::span<const TemplatePoint> points);

 private:
  [[nodiscard]] float steepness(const TemplatePoint& point) const;
  [[nodiscard]] std::size_t pixel_of(const TemplatePoint& point) const;
  void select_steepest(std::span<const TemplatePoint> points);
  void select_patches(std::span<const TemplatePoint> points);
  void mark_patch(std::size_t centre);

  SelectionOptions options_;
  PinholeCamera camera_;
  std::vector<TemplatePoint> chosen_;
  std::vector<float> steepness_, sorted_;
  std::vector<const TemplatePoint*> steepest_of_cell_;
  std::vector<std::uint8_t> in_patch_;  ///< per pixel
};

}  // namespace saccade
