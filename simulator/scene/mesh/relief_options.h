#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>

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

}  // namespace saccade
