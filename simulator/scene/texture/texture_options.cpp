#include "simulator/scene/texture/texture_options.h"

#include <string_view>

#include "core/config/config.h"

namespace saccade {
namespace {

constexpr double kMostTexels = 16384;

}  // namespace

void describe(config::Fields& fields, TextureOptions& options) {
  fields.value("size_m", options.size_m, "width and height of what the texture covers").above(0);
  fields.value("texels_per_m", options.texels_per_m, "resolution").above(0);
  fields.value("seed", options.seed, "another texture of the same kind");
  fields.value("albedo", options.albedo, "darkest and lightest, in linear light").range(1e-4, 1);
  fields.value("edge_texels", options.edge_texels, "width over which edges blend").range(0.5, 10);
  const auto ordered = [](config::Fields& group, std::string_view key, const auto& range) {
    group.expect(range[0] <= range[1], key, "must not fall: the smaller number comes first");
  };
  ordered(fields, "albedo", options.albedo);
  for (const double side : options.size_m) {
    const double texels = side * options.texels_per_m;
    fields.expect(texels >= 2 && texels <= kMostTexels, "size_m",
                  "times texels_per_m must be 2 to 16384 texels");
  }
  fields.group(
      "shapes",
      [&](config::Fields& group) {
        auto& shapes = options.shapes;
        group.value("diameter_m", shapes.diameter_m, "smallest and largest").above(0);
        group.expect(shapes.diameter_m[0] < shapes.diameter_m[1], "diameter_m",
                     "must rise: the smaller number comes first");
        group.value("coverage", shapes.coverage, "their area over the texture's").range(0, 50);
        group.value("opacity", shapes.opacity, "faintest and strongest").range(0, 1);
        ordered(group, "opacity", shapes.opacity);
        group.value("leaves", shapes.leaves, "share of leaves with veins among them").range(0, 1);
      },
      "discs, rectangles and polygons that cover one another");
  fields.group(
      "lines",
      [&](config::Fields& group) {
        auto& lines = options.lines;
        group.value("per_m2", lines.per_m2, "how many").range(0, 1e4);
        group.value("length_m", lines.length_m, "shortest and longest").above(0);
        ordered(group, "length_m", lines.length_m);
        group.value("width_m", lines.width_m, "of each line").above(0);
      },
      "thin lines");
  fields.group(
      "text",
      [&](config::Fields& group) {
        auto& text = options.text;
        group.value("per_m2", text.per_m2, "blocks").range(0, 1e3);
        group.value("height_m", text.height_m, "of a letter").above(0);
        group.value("lines", text.lines, "fewest and most in a block").range(1, 100);
        ordered(group, "lines", text.lines);
        group.value("letters", text.letters, "fewest and most in a line").range(1, 200);
        ordered(group, "letters", text.letters);
      },
      "blocks of strokes like text");
  fields.group(
      "noise",
      [&](config::Fields& group) {
        auto& noise = options.noise;
        group.value("wavelength_m", noise.wavelength_m, "shortest and longest").above(0);
        ordered(group, "wavelength_m", noise.wavelength_m);
        group.value("strength", noise.strength, "largest change of the log albedo").range(0, 5);
      },
      "smooth variation");
}

TextureOptions read_texture_options(const std::filesystem::path& file) {
  return config::read<TextureOptions>(config::load(file));
}

}  // namespace saccade
