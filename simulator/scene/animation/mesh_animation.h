#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace saccade {

/// Shorter intervals between two poses of a MeshAnimation are jumps, not motions.
constexpr double kJump_s = 1e-5;

/// Poses of a mesh, between which its vertices move on straight lines at constant speed.
struct MeshAnimation {
  using Vectors = std::vector<Eigen::Vector3f>;

  std::string name;
  std::vector<double> times_s;      ///< of the poses, at least 2, increasing from 0
  std::vector<Vectors> vertices;    ///< of each pose: one per vertex of the mesh
  std::vector<Vectors> normals;     ///< likewise, for shading
  bool has_scaled_weights = false;  ///< weights of bones did not sum to one

  [[nodiscard]] double duration_s() const { return times_s.back(); }
};

}  // namespace saccade
