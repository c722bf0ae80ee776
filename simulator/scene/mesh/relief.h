#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "simulator/scene/mesh/mesh.h"

namespace saccade {

namespace config {
class Fields;
}

/// A smooth relief: rows of dunes whose crests bend, and swells of many sizes. Its height is a
/// twice continuously differentiable function of the place that does not depend on `triangles`, so
/// the same relief comes in any fineness. It lies around the origin, z up.
struct ReliefOptions {
  std::array<double, 2> size_m{10, 10};
  std::uint64_t triangles = 40'000;
  std::uint64_t seed = 1;
  std::optional<std::filesystem::path> texture;
  double albedo = 0.5;

  struct Dunes {
    double height_m = 0.6;
    std::array<double, 2> across{1, 0};  ///< direction from crest to crest; of any length > 0
    double wavelength_m = 3;
    double rise = 0.65;
    double bend_m = 0.8;
    double bend_wavelength_m = 4;
  } dunes;
  struct Swell {
    double height_m = 0.3;
    std::array<double, 2> wavelength_m{0.8, 4};
  } swell;
};

void describe(config::Fields& fields, ReliefOptions& options);

/// Reads a *.relief.yaml. Throws InputError with its position.
[[nodiscard]] ReliefOptions read_relief_options(const std::filesystem::path& file);

/// Height over a point of the ground and how it changes there.
struct Elevation {
  double height = 0;                                ///< [m]
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< d height / d (x, y)
};

/// Smooth noise: random values in [-1, 1] on a square lattice, between them interpolated with
/// f(t) = t^3 (6 t^2 - 15 t + 10), whose first and second derivatives vanish at both ends; hence
/// C2.
class SmoothNoise {
 public:
  /// Covers [0, size] with values from `stream` of `seed`.
  SmoothNoise(std::uint64_t seed, std::uint64_t stream, const Eigen::Vector2d& size,
              double wavelength_m);

  [[nodiscard]] Elevation at(const Eigen::Vector2d& point) const;

 private:
  double frequency_;  ///< [1/m]
  int columns_, rows_;
  std::vector<double> values_;
};

/// The height function of a relief:
///   h(p) = H a(p) f(phase(p)) + sum_k H_k N_k(p)
///   phase(p) = (p . across + bend N_b(p)) / wavelength
/// where f rises smoothly from 0 to 1 over the fraction kRise of a period and falls over the rest,
/// a in [0.5, 1] lets crests rise and sink, and all N are SmoothNoise. C2. Uses additions and
/// products alone, so that builds without fused operations agree to the bit.
class Relief {
 public:
  /// Throws InputError when an option is out of range.
  explicit Relief(const ReliefOptions& options);

  /// `point`: within [-size / 2, size / 2].
  [[nodiscard]] Elevation at(const Eigen::Vector2d& point) const;

 private:
  [[nodiscard]] Elevation dunes(const Eigen::Vector2d& point) const;

  struct Octave {
    SmoothNoise noise;
    double height_m;
  };
  ReliefOptions options_;
  Eigen::Vector2d size_, across_;
  SmoothNoise bend_, crest_;
  std::vector<Octave> swell_;
};

/// Tessellates the relief: shared vertices with the exact normals, texture coordinates that lay one
/// texture over the whole. `texture` may be null. Throws InputError when an option is out of range.
[[nodiscard]] Mesh generate_relief(const ReliefOptions& options,
                                   std::shared_ptr<const Texture> texture = nullptr);

}  // namespace saccade
