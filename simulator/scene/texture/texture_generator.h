#pragma once

#include <array>
#include <cstdint>
#include <filesystem>

#include "core/image.h"

namespace saccade {

namespace config {
class Fields;
}

/// A texture for synthetic surfaces: opaque and translucent discs, rectangles and polygons of many
/// sizes that cover one another ("dead leaves", whose statistics are those of natural scenes; Lee,
/// Mumford and Huang, IJCV 41, 2001), thin lines, blocks of strokes like text, and smooth noise.
/// Nothing in it repeats. Lengths are in metres of the surface that it covers.
struct TextureOptions {
  std::array<double, 2> size_m{2, 2};
  double texels_per_m = 250;
  std::uint64_t seed = 1;
  std::array<double, 2> albedo{0.05, 0.95};
  double edge_texels = 1.4;

  struct Shapes {
    std::array<double, 2> diameter_m{0.02, 0.8};
    double coverage = 3;
    std::array<double, 2> opacity{0.3, 1};
    double leaves = 0;
  } shapes;
  struct Lines {
    double per_m2 = 4;
    std::array<double, 2> length_m{0.1, 0.6};
    double width_m = 0.008;
  } lines;
  struct Text {
    double per_m2 = 0.8;
    double height_m = 0.04;
    std::array<int, 2> lines{1, 5};
    std::array<int, 2> letters{4, 16};
  } text;
  struct Noise {
    std::array<double, 2> wavelength_m{0.03, 0.5};
    double strength = 0.1;
  } noise;
};

void describe(config::Fields& fields, TextureOptions& options);

/// Reads a *.texture.yaml. Throws InputError with its position.
[[nodiscard]] TextureOptions read_texture_options(const std::filesystem::path& file);

/// The same picture for any number of threads, in linear light within `albedo`. Throws InputError
/// when an option is out of range.
[[nodiscard]] ImageF generate_texture(const TextureOptions& options);

}  // namespace saccade
