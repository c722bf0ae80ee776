#pragma once

#include <cmath>
#include <cstdint>
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
/// a depth test. Between neighbours that are not joined nothing is known.
class MapView {
 public:
  /// `map` outlives the view. The view has a node at every `step_px`-th pixel, of the image as of
  /// the map's pictures, and `margin` nodes more on all sides.
  MapView(const IntensityMap& map, int margin, int step_px = 1);

  void draw(const Rigid3& map_from_camera);

  /// How far its points have moved in the image since it was drawn: the furthest of a few spread
  /// over it [px]; infinity where one is behind the camera.
  [[nodiscard]] double moved_px(const Rigid3& map_from_camera) const;

  [[nodiscard]] const Rigid3& map_from_camera() const { return map_from_camera_; }
  /// Node (x, y) is pixel (step x, step y).
  [[nodiscard]] int step_px() const { return step_; }
  [[nodiscard]] Eigen::Vector2i node_at(const Eigen::Vector2f& pixel) const {
    const float scale = 1 / static_cast<float>(step_);
    return {static_cast<int>(std::floor(pixel.x() * scale + 0.5F)),
            static_cast<int>(std::floor(pixel.y() * scale + 0.5F))};
  }
  /// Whether a node belongs to the view, with its margin.
  [[nodiscard]] bool contains(int x, int y) const {
    return x >= -margin_ && y >= -margin_ && x < places_.width() - margin_ &&
           y < places_.height() - margin_;
  }
  /// What a node that the view contains sees.
  [[nodiscard]] const SeenPlace& operator()(int x, int y) const {
    return places_(x + margin_, y + margin_);
  }
  /// Share of the image's nodes that see a known place.
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
    Eigen::Vector2f place;
  };

  /// Nodes that may lie between some vertices; most often one, as the map's squares are about as
  /// large as the view's.
  struct Nodes {
    int left = 0, top = 0, right = -1, bottom = -1;  ///< both ends belong to it
    [[nodiscard]] bool is_empty() const { return left > right || top > bottom; }
  };

  /// The few that look most nearly the same way, the nearest first.
  [[nodiscard]] std::vector<std::size_t> nearest_views() const;
  [[nodiscard]] bool is_one_surface(const IntensityMap::View& view, int x, int y) const;
  /// Index of a node's pixel in a picture of the map.
  [[nodiscard]] std::size_t pixel_of(int x, int y) const {
    return static_cast<std::size_t>(y * step_) * static_cast<std::size_t>(map_.camera().width) +
           static_cast<std::size_t>(x * step_);
  }
  void project(const IntensityMap::View& view);
  void draw_view(const IntensityMap::View& view, const std::vector<std::uint8_t>& is_joined);
  [[nodiscard]] Nodes nodes_between(const Vertex& a, const Vertex& b, const Vertex& c,
                                    const Vertex& d) const;
  void draw_triangle(const Corner& a, const Corner& b, const Corner& c, const Nodes& nodes);
  void measure();

  const IntensityMap& map_;
  int margin_;
  int step_;
  int columns_, rows_;  ///< of nodes in the image
  /// For each of the map's views, 1 where the square from a node to the next ones is one surface.
  std::vector<std::vector<std::uint8_t>> is_joined_;
  Rigid3 map_from_camera_;
  Image<SeenPlace> places_;
  std::vector<Vertex> vertices_;
  double coverage_ = 0;
  double typical_depth_m_ = 1;
};

}  // namespace saccade
