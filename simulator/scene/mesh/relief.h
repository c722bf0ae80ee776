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

/// A smooth relief: rows of dunes whose crests bend, swells of many sizes, and ripples. Its height
/// is a function of the place that does not depend on `triangles`, so the same relief comes in any
/// fineness. It is twice continuously differentiable, but at the crests of rows whose sharpness is
/// above 0. It lies around the origin, z up.
struct ReliefOptions {
  std::array<double, 2> size_m{10, 10};
  std::uint64_t triangles = 40'000;
  std::uint64_t seed = 1;
  std::optional<std::filesystem::path> texture;
  std::optional<std::array<double, 2>> texture_size_m;  ///< default: size_m, once over the whole
  double albedo = 0.5;

  struct Rows {
    double height_m = 0.6;
    std::array<double, 2> across{1, 0};  ///< direction from crest to crest; of any length > 0
    double wavelength_m = 3;
    double rise = 0.65;
    double sharpness = 0;  ///< 0: crests are round; 1: straight slopes meet at them
    double bend_m = 0.8;
    double bend_wavelength_m = 4;
  };
  Rows dunes;
  struct Swell {
    double height_m = 0.3;
    std::array<double, 2> wavelength_m{0.8, 4};
  } swell;
  Rows ripples{
      .height_m = 0, .wavelength_m = 0.15, .rise = 0.6, .bend_m = 0.1, .bend_wavelength_m = 0.6};
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

/// Rows of crests that bend, rise and sink:
///   h(p) = H a(p) f(phase(p)),   phase(p) = (p . across + bend N_b(p)) / wavelength
///   f(t) = g(t / rise) for t < rise, else g((1 - t) / (1 - rise)),   t = phase - floor(phase)
///   g(t) = (1 - sharpness) t^3 (6 t^2 - 15 t + 10) + sharpness t^3 (2 - t)
/// with a in [0.5, 1] and SmoothNoise for N_b and a. The second part of g has the slope 2 and no
/// curvature at the crest. C2, but at the crests where sharpness > 0.
class CrestRows {
 public:
  /// Draws from `stream` and `stream` + 1 of `seed`.
  CrestRows(const ReliefOptions::Rows& options, std::uint64_t seed, std::uint64_t stream,
            const Eigen::Vector2d& size);

  /// `point`: within [0, size].
  [[nodiscard]] Elevation at(const Eigen::Vector2d& point) const;

 private:
  ReliefOptions::Rows options_;
  Eigen::Vector2d across_;
  SmoothNoise bend_, crest_;
};

/// The height function of a relief: rows of dunes, a sum of SmoothNoise of falling wavelengths, and
/// ripples. Uses additions and products alone, so that builds without fused operations agree to the
/// bit.
class Relief {
 public:
  /// Throws InputError when an option is out of range.
  explicit Relief(const ReliefOptions& options);

  /// `point`: within [-size / 2, size / 2].
  [[nodiscard]] Elevation at(const Eigen::Vector2d& point) const;

 private:
  struct Octave {
    SmoothNoise noise;
    double height_m;
  };
  Eigen::Vector2d size_;
  CrestRows dunes_;
  std::vector<Octave> swell_;
  std::optional<CrestRows> ripples_;
};

/// Tessellates the relief: shared vertices with the exact normals, texture coordinates that lay the
/// texture over the whole, once or repeated. `texture` may be null. Throws InputError when an option is out of range.
[[nodiscard]] Mesh generate_relief(const ReliefOptions& options,
                                   std::shared_ptr<const Texture> texture = nullptr);

}  // namespace saccade
