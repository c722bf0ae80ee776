#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/image.h"
#include "core/rigid3.h"
#include "estimator/tracking/intensity_map.h"

namespace saccade {

/// A place of the map as a pixel of a camera sees it.
struct SeenPlace {
  Eigen::Vector3f point;  ///< in the map's frame [m]
  float inverse_depth;    ///< in the camera's frame [1/m]; 0: nothing known is seen
  Eigen::Vector2f place;  ///< in the atlas [px]
  Eigen::Matrix2f scale;  ///< how it moves with the pixel [px/px]
};

/// Which places of a map a camera sees: the map's pictures as meshes of small triangles, drawn with
/// a depth test. Neighbours with very different depths belong to different surfaces and are not
/// joined: between them nothing is known.
class MapView {
 public:
  /// `map` outlives the view; it reaches `margin_px` beyond the image on all sides.
  MapView(const IntensityMap& map, int margin_px);

  void draw(const Rigid3& map_from_camera);

  [[nodiscard]] const Rigid3& map_from_camera() const { return map_from_camera_; }
  /// `x`, `y`: within the image or the margin around it.
  [[nodiscard]] bool contains(int x, int y) const {
    return x >= -margin_ && y >= -margin_ && x < places_.width() - margin_ &&
           y < places_.height() - margin_;
  }
  [[nodiscard]] const SeenPlace& operator()(int x, int y) const {
    return places_(x + margin_, y + margin_);
  }
  /// Share of the image's pixels that see a known place.
  [[nodiscard]] double coverage() const { return coverage_; }
  /// Harmonic mean of the depths [m]; 1 where nothing is known.
  [[nodiscard]] double typical_depth_m() const { return typical_depth_m_; }

 private:
  /// A point of the map in the image.
  struct Vertex {
    float x, y;
    float inverse_depth;  ///< 0: behind the camera, or unknown
  };
  struct Corner {
    const Vertex& vertex;
    const Eigen::Vector3f& point;
    Eigen::Vector2f place;
  };

  /// The few that look most nearly the same way, the nearest first.
  [[nodiscard]] std::vector<std::size_t> nearest_views() const;
  void project(const IntensityMap::View& view);
  void draw_view(const IntensityMap::View& view);
  void draw_triangle(const Corner& a, const Corner& b, const Corner& c);
  void measure();

  const IntensityMap& map_;
  int margin_;
  Rigid3 map_from_camera_;
  Image<SeenPlace> places_;
  std::vector<Vertex> vertices_;
  double coverage_ = 0;
  double typical_depth_m_ = 1;
};

}  // namespace saccade
