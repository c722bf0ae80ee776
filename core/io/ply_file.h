#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "core/image.h"

namespace saccade {

/// Points with optional attributes; each attribute is empty or as long as `positions`.
struct PointCloud {
  struct Scalar {
    std::string name;  ///< PLY property, a word ("intensity")
    std::vector<float> values;
  };

  std::vector<Eigen::Vector3f> positions;  ///< [m]
  std::vector<Eigen::Vector3f> normals;
  std::vector<Rgb8> colours;
  std::vector<Scalar> scalars;
};

/// Reads the vertices of a PLY file, ASCII or binary little endian; further elements are skipped,
/// list properties of vertices are not supported. InputError with the path.
[[nodiscard]] PointCloud read_ply(const std::filesystem::path& file);
/// Binary little endian, all float32 but the colours.
void write_ply(const std::filesystem::path& file, const PointCloud& cloud);

}  // namespace saccade
