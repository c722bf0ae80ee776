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
  std::array<double, 2> size_m{10, 10};  ///< along x and y
  std::uint64_t triangles = 40'000;      ///< about: whole rows and columns of nearly square cells
  std::uint64_t seed = 1;
  std::optional<std::filesystem::path> texture;  ///< picture or *.texture.yaml, laid over the whole
  double albedo = 0.5;                           ///< without a texture; linear light

  struct Dunes {
    double height_m = 0.6;               ///< of the highest crests above the troughs; 0: none
    std::array<double, 2> across{1, 0};  ///< direction from crest to crest; of any length > 0
    double wavelength_m = 3;             ///< from crest to crest
    double rise = 0.65;                  ///< share of a wavelength on the gentle side
    double bend_m = 0.8;                 ///< how far crests stray from straight lines
    double bend_wavelength_m = 4;        ///< how often; crests rise and sink as often
  } dunes;
  struct Swell {
    double height_m = 0.3;                       ///< largest deviation from flat; 0: none
    std::array<double, 2> wavelength_m{0.8, 4};  ///< shortest, longest; height ~ wavelength
  } swell;
};

void describe(config::Fields& fields, ReliefOptions& options);

/// Reads a *.relief.yaml. Throws InputError with its place.
[[nodiscard]] ReliefOptions read_relief_options(const std::filesystem::path& file);

}  // namespace saccade
