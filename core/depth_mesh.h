#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/image.h"
#include "core/rigid3.h"

namespace saccade {

/// A dense depth map as a surface: triangles between neighbouring pixels whose depths are alike, to
/// be drawn from anywhere with a depth test. 1 / z is linear in the image, exact on planes.
class DepthMesh {
 public:
  /// `depth`: z [m] on the sensor of `camera` with its lens, 0 = unknown. Neighbours whose depths
  /// differ by more than 10 % are not joined.
  DepthMesh(const ImageF& depth, const PinholeCamera& camera);

  /// A pixel's point in the image that is drawn.
  struct Vertex {
    float x, y;
    float inverse_depth;  ///< 0: behind the camera, or unknown
  };

  /// All pixels' points as `camera` (no lens) sees them, in row-major order, wherever they fall.
  [[nodiscard]] std::vector<Vertex> project(const Rigid3& camera_from_mesh,
                                            const PinholeCamera& camera) const;

  /// 1 / z [1/m] of what is seen in front, 0 = nothing known; what lies between pixels that are not
  /// joined stays unknown. Exact to 1e-6 of the depth (single precision).
  void draw(std::span<const Vertex> vertices, ImageF& inverse_depth) const;

  /// The same at once; `inverse_depth` has the camera's size.
  void draw(const Rigid3& camera_from_mesh, const PinholeCamera& camera,
            ImageF& inverse_depth) const;

  /// Harmonic mean of the depths [m]; 1 where none is known.
  [[nodiscard]] float typical_depth_m() const { return typical_depth_m_; }

 private:
  int width_, height_;
  std::vector<Eigen::Vector3f> points_;  ///< z = 0: unknown
  std::vector<std::uint8_t> triangles_;  ///< of the square from a pixel: bit 0 upper, bit 1 lower
  float typical_depth_m_ = 1;
};

}  // namespace saccade
