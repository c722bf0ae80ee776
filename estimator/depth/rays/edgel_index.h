#pragma once

#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "estimator/depth/rays/ray_gatherer.h"

namespace saccade {

/// The edgels found so far, indexed by pixel.
class EdgelIndex {
 public:
  EdgelIndex(const PinholeCamera& camera, float spacing_px);

  void add(const Edgel& edge);
  /// Whether an edgel of similar direction lies within the spacing, its inverse depth closer than
  /// `tolerance`.
  [[nodiscard]] bool has_similar(const Edgel& edge, float tolerance) const;

 private:
  static constexpr int kNone = -1;
  struct Entry {
    Edgel edge;
    int previous;  ///< of the same pixel
  };

  Image<int> newest_;  ///< of each pixel
  std::vector<Entry> edges_;
  float spacing_px_;
};

}  // namespace saccade
