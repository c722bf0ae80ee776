#include "simulator/scene/texture/texture_options.h"

#include <string_view>

#include "core/config/config.h"

namespace saccade {
namespace {

constexpr double kMaxTexels = 16384;

template <class Range>
void ordered(config::Fields& fields, std::string_view key, const Range& range) {
  fields.expect(range[0] <= range[1], key, "must not fall: the smaller number comes first");
}

void describe_shapes(config::Fields& group, TextureOptions::Shapes& shapes) {
  group
      .value("diameter_m", shapes.diameter_m,
             "Smallest and largest diameter of the shapes, in metres.")
      .above(0);
  group.expect(shapes.diameter_m[0] < shapes.diameter_m[1], "diameter_m",
               "must rise: the smaller number comes first");
  group
      .value("coverage", shapes.coverage,
             "Total area of the shapes over the area of the texture; larger values cover more.")
      .range(0, 50);
  group.value("opacity", shapes.opacity, "Smallest and largest opacity of the shapes.").range(0, 1);
  ordered(group, "opacity", shapes.opacity);
  group.value("leaves", shapes.leaves, "Fraction of the shapes that are leaves with veins.")
      .range(0, 1);
}

void describe_lines(config::Fields& group, TextureOptions::Lines& lines) {
  group.value("per_m2", lines.per_m2, "Number of lines per square metre.").range(0, 1e4);
  group.value("length_m", lines.length_m, "Shortest and longest length of the lines, in metres.")
      .above(0);
  ordered(group, "length_m", lines.length_m);
  group.value("width_m", lines.width_m, "Width of the lines, in metres.").above(0);
}

void describe_text(config::Fields& group, TextureOptions::Text& text) {
  group.value("per_m2", text.per_m2, "Number of blocks of text per square metre.").range(0, 1e3);
  group.value("height_m", text.height_m, "Height of a letter, in metres.").above(0);
  group.value("lines", text.lines, "Fewest and most lines in a block.").range(1, 100);
  ordered(group, "lines", text.lines);
  group.value("letters", text.letters, "Fewest and most letters in a line.").range(1, 200);
  ordered(group, "letters", text.letters);
}

void describe_noise(config::Fields& group, TextureOptions::Noise& noise) {
  group
      .value("wavelength_m", noise.wavelength_m,
             "Shortest and longest wavelength of the noise, in metres.")
      .above(0);
  ordered(group, "wavelength_m", noise.wavelength_m);
  group.value("strength", noise.strength, "Largest change of the log albedo. 0 disables the noise.")
      .range(0, 5);
}

}  // namespace

void describe(config::Fields& fields, TextureOptions& options) {
  fields
      .value("size_m", options.size_m,
             "Width and height of the surface that the texture covers, in metres.")
      .above(0);
  fields.value("texels_per_m", options.texels_per_m, "Resolution, in texels per metre.").above(0);
  fields.value("seed", options.seed,
               "Seed; another seed gives another texture with the same statistics.");
  fields.value("albedo", options.albedo, "Darkest and lightest albedo, in linear light.")
      .range(1e-4, 1);
  fields
      .value("edge_texels", options.edge_texels,
             "Width over which the edges of shapes blend, in texels; smaller values give sharper "
             "edges.")
      .range(0.5, 10);
  ordered(fields, "albedo", options.albedo);
  for (const double side : options.size_m) {
    const double texels = side * options.texels_per_m;
    fields.expect(texels >= 2 && texels <= kMaxTexels, "size_m",
                  "times texels_per_m must be 2 to 16384 texels");
  }
  fields.group(
      "shapes", [&](config::Fields& group) { describe_shapes(group, options.shapes); },
      "Discs, rectangles and polygons that cover one another.");
  fields.group(
      "lines", [&](config::Fields& group) { describe_lines(group, options.lines); }, "Thin lines.");
  fields.group(
      "text", [&](config::Fields& group) { describe_text(group, options.text); },
      "Blocks of strokes that look like text.");
  fields.group(
      "noise", [&](config::Fields& group) { describe_noise(group, options.noise); },
      "Smooth variation of the albedo.");
}

TextureOptions read_texture_options(const std::filesystem::path& file) {
  return config::read<TextureOptions>(config::load(file));
}

}  // namespace saccade
