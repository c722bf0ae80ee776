#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/image.h"
#include "core/rigid3.h"
#include "estimator/tracking/intensity_map.h"

namespace saccade {

/// The point of the map that a pixel of a camera sees.
struct MapSample {
  Eigen::Vector3f point;            ///< in the map's frame [m]
  float inverse_depth;              ///< in the camera's frame [1/m]; 0: nothing known is visible
  Eigen::Vector2f atlas_px;         ///< its reprojection into the map's atlas [px]
  Eigen::Matrix2f atlas_per_pixel;  ///< d atlas_px / d pixel
};

/// The map rendered into a camera: its pictures as meshes of small triangles, drawn with a depth
/// test. Between neighbours that are not joined nothing is known.
class MapView {
 public:
  /// `map` outlives the view. The view has a node at every `spacing_px`-th pixel, of the image as
  /// of the map's pictures, and `margin` nodes more on all sides.
  MapView(const IntensityMap& map, int margin, int spacing_px = 1);

  void draw(const Rigid3& map_from_camera);

  /// How far its points have moved in the image since it was drawn: the furthest of a few spread
  /// over it [px]; infinity where one is behind the camera.
  [[nodiscard]] double moved_px(const Rigid3& map_from_camera) const;

  [[nodiscard]] const Rigid3& map_from_camera() const { return map_from_camera_; }
  /// Node (x, y) is pixel (spacing x, spacing y).
  [[nodiscard]] int spacing_px() const { return spacing_; }
  [[nodiscard]] Eigen::Vector2i node_at(const Eigen::Vector2f& pixel) const {
    const float scale = 1 / static_cast<float>(spacing_);
    return {static_cast<int>(std::floor(pixel.x() * scale + 0.5F)),
            static_cast<int>(std::floor(pixel.y() * scale + 0.5F))};
  }
  /// Whether a node belongs to the view, with its margin.
  [[nodiscard]] bool contains(int x, int y) const {
    return x >= -margin_ && y >= -margin_ && x < samples_.width() - margin_ &&
           y < samples_.height() - margin_;
  }
  /// The map at a node that the view contains.
  [[nodiscard]] const MapSample& operator()(int x, int y) const {
    return samples_(x + margin_, y + margin_);
  }
  /// Fraction of the image's nodes at which the map is visible.
  [[nodiscard]] double coverage() const { return coverage_; }
  /// Harmonic mean of the depths [m]; 1 where nothing is known.
  [[nodiscard]] double typical_depth_m() const { return typical_depth_m_; }

 private:
  /// A point of the map in the image, in nodes.
  struct Vertex {
    float x, y;
    float inverse_depth;  ///< 0: behind the camera, or unknown
  };
  struct Corner {
    const Vertex& vertex;
    const Eigen::Vector3f& point;
    Eigen::Vector2f atlas_px;
  };

  /// Nodes that may lie between some vertices; most often one, as the map's squares are about as
  /// large as the view's.
  struct Nodes {
    int left = 0, top = 0, right = -1, bottom = -1;  ///< both ends belong to it
    [[nodiscard]] bool is_empty() const { return left > right || top > bottom; }
  };

  /// The few with the most similar orientation, the nearest first.
  [[nodiscard]] std::vector<std::size_t> nearest_views() const;
  [[nodiscard]] bool is_one_surface(const IntensityMap::View& view, int x, int y) const;
  /// Index of a node's pixel in a picture of the map.
  [[nodiscard]] std::size_t pixel_of(int x, int y) const {
    return static_cast<std::size_t>(y * spacing_) * static_cast<std::size_t>(map_.camera().width) +
           static_cast<std::size_t>(x * spacing_);
  }
  void project(const IntensityMap::View& view);
  void draw_view(const IntensityMap::View& view, const std::vector<std::uint8_t>& is_joined);
  [[nodiscard]] Nodes nodes_between(const Vertex& a, const Vertex& b, const Vertex& c,
                                    const Vertex& d) const;
  void draw_triangle(const Corner& a, const Corner& b, const Corner& c, const Nodes& nodes);
  void measure();

  const IntensityMap& map_;
  int margin_;
  int spacing_;
  int columns_, rows_;  ///< of nodes in the image
  /// For each of the map's views, 1 where the square from a node to the next ones is one surface.
  std::vector<std::vector<std::uint8_t>> is_joined_;
  Rigid3 map_from_camera_;
  Image<MapSample> samples_;
  std::vector<Vertex> vertices_;
  double coverage_ = 0;
  double typical_depth_m_ = 1;
};

}  // namespace saccade
