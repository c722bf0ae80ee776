#include "simulator/scene/texture/texture_generator.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "core/config/config.h"
#include "core/process/parallel.h"
#include "core/random.h"
#include "simulator/scene/texture/texture_shapes.h"

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

constexpr std::uint64_t kMaxShapes = 4'000'000;

/// Half lengths from which leaves get a midrib and veins, and the width of these [texel].
constexpr float kShortestRibbed = 3;
constexpr float kShortestVeined = 7;
constexpr double kThinnestVein = 1;

/// Who draws random numbers; lattices of noise follow from kNoise on, one per octave.
enum TextureStream : std::uint64_t { kBackground, kShapes, kLines, kText, kLetters, kNoise = 16 };

/// Draws in a row that belong to one item of a stream. Each draw is a statement of its own: in which
/// order a call evaluates its arguments is the compiler's choice, and two make two textures.
class Dice {
 public:
  Dice(const Random& random, std::uint64_t stream, std::uint64_t item)
      : random_(random), stream_(stream), next_(item * kDrawsPerItem) {}

  double uniform() { return random_.uniform(stream_, next_++); }
  double between(const std::array<double, 2>& range) {
    return range[0] + uniform() * (range[1] - range[0]);
  }
  int between(const std::array<int, 2>& range) {
    return range[0] + static_cast<int>(uniform() * (range[1] - range[0] + 1));
  }
  /// A unit vector, by rejection: square roots give the same bits everywhere, sines do not.
  Eigen::Vector2d direction() {
    for (int i = 0; i < 16; ++i) {
      const double y = 2 * uniform() - 1;
      const double x = 2 * uniform() - 1;
      const Eigen::Vector2d v(x, y);
      if (v.squaredNorm() <= 1 && v.squaredNorm() > 0.01) return v.normalized();
    }
    return Eigen::Vector2d::UnitX();
  }

 private:
  static constexpr std::uint64_t kDrawsPerItem = 64;
  const Random& random_;
  std::uint64_t stream_;
  std::uint64_t next_;
};

/// Draws the layers of one texture. The image holds the log of the albedo until the end, so that a
/// shape of a given opacity has the same contrast on dark and on light ground.
class Generator {
 public:
  explicit Generator(const TextureOptions& options)
      : options_(options),
        random_(options.seed),
        scale_(options.texels_per_m),
        width_(static_cast<int>(std::lround(options.size_m[0] * scale_))),
        height_(static_cast<int>(std::lround(options.size_m[1] * scale_))),
        log_dark_(std::log(options.albedo[0])),
        log_light_(std::log(options.albedo[1])),
        image_(width_, height_) {}

  [[nodiscard]] ImageF run() {
    Dice dice(random_, kBackground, 0);
    image_.fill(log_albedo(dice));
    add_covering_shapes();
    add_lines();
    add_text();
    draw_shapes(image_, shapes_, static_cast<float>(options_.edge_texels));
    add_noise();
    expose();
    return std::move(image_);
  }

 private:
  [[nodiscard]] double area_m2() const { return options_.size_m[0] * options_.size_m[1]; }

  float log_albedo(Dice& dice) const {
    return static_cast<float>(log_dark_ + dice.uniform() * (log_light_ - log_dark_));
  }

  /// In texels, also a little outside, so that borders are no emptier than the middle.
  Eigen::Vector2f position(Dice& dice, double margin) const {
    return {static_cast<float>(-margin + dice.uniform() * (width_ + 2 * margin)),
            static_cast<float>(-margin + dice.uniform() * (height_ + 2 * margin))};
  }

  void add_covering_shapes() {
    const auto& [diameter, coverage, opacity, leaves] = options_.shapes;
    const double a = diameter[0];
    const double b = diameter[1];
    // Mean of pi/4 d^2 under a density ~ d^-3 between a and b; the shapes fill about 0.7 of a disc,
    // leaves 0.3.
    const double filled = 0.7 * (1 - leaves) + 0.3 * leaves;
    const double mean_area = filled * 0.785 * 2 * std::log(b / a) / (1 / (a * a) - 1 / (b * b));
    const double margin = 0.5 * b * scale_;
    const double drawn_m2 = (width_ + 2 * margin) * (height_ + 2 * margin) / (scale_ * scale_);
    const auto count = static_cast<std::uint64_t>(coverage * drawn_m2 / mean_area);
    for (std::uint64_t i = 0; i < std::min(count, kMaxShapes); ++i) {
      Dice dice(random_, kShapes, i);
      const double shrink = 1 - (a / b) * (a / b);
      const double size = a / std::sqrt(1 - dice.uniform() * shrink);  // inverts the distribution
      TextureShape shape;
      shape.center = position(dice, margin);
      shape.reach = static_cast<float>(0.5 * size * scale_);
      shape.log_albedo = log_albedo(dice);
      shape.opacity = static_cast<float>(dice.between(opacity));
      const double draw = dice.uniform();
      if (draw < leaves) {
        add_leaf(std::move(shape), dice);
        continue;
      }
      const double kind = (draw - leaves) / (1 - leaves);
      if (kind < 0.3) {
        shape.half_width = shape.reach;
      } else if (kind < 0.65) {
        add_rectangle_sides(shape, dice);
      } else {
        add_polygon_sides(shape, dice);
      }
      shapes_.push_back(std::move(shape));
    }
  }

  /// A leaf with a midrib and, where they show, side veins of one other grey level.
  void add_leaf(TextureShape leaf, Dice& dice) {
    const Eigen::Vector2f axis = dice.direction().cast<float>();
    const float length = leaf.reach;
    leaf.half_axis = length * axis;
    leaf.half_width = static_cast<float>(0.25 + 0.25 * dice.uniform()) * length;
    leaf.arc_radius = (length * length + leaf.half_width * leaf.half_width) / (2 * leaf.half_width);
    const Eigen::Vector2f center = leaf.center;
    const Eigen::Vector2f across = leaf.half_width * Eigen::Vector2f(-axis.y(), axis.x());
    shapes_.push_back(std::move(leaf));
    const float level = log_albedo(dice);
    const double width = std::max(0.07 * length, kThinnestVein);
    if (length < kShortestRibbed) return;
    add_stroke(center - length * axis, center + 0.9F * length * axis, width, level);
    if (length < kShortestVeined) return;
    for (const float offset : {-0.5F, -0.1F, 0.3F})
      for (const float side : {-0.6F, 0.6F}) {
        const Eigen::Vector2f root = center + offset * length * axis;
        const Eigen::Vector2f reach = 0.3F * length * axis + (1 - offset * offset) * side * across;
        add_stroke(root, root + reach, 0.7 * width, level);
      }
  }

  static void add_rectangle_sides(TextureShape& shape, Dice& dice) {
    const Eigen::Vector2f x = dice.direction().cast<float>();
    const Eigen::Vector2f y(-x.y(), x.x());
    const auto aspect = static_cast<float>(0.25 + 0.75 * dice.uniform());
    const float half_length = shape.reach / std::sqrt(1 + aspect * aspect);
    for (const float sign : {-1.0F, 1.0F}) {
      shape.sides.emplace_back(sign * x.x(), sign * x.y(), half_length);
      shape.sides.emplace_back(sign * y.x(), sign * y.y(), aspect * half_length);
    }
  }

  /// Cuts a regular hexagon by three further sides, which makes polygons of three to nine corners.
  static void add_polygon_sides(TextureShape& shape, Dice& dice) {
    const Eigen::Vector2f x = dice.direction().cast<float>();
    const Eigen::Vector2f y(-x.y(), x.x());
    const float inner = 0.866F * shape.reach;
    for (const float sign : {-1.0F, 1.0F})
      for (const float part : {-0.866F, 0.0F, 0.866F}) {
        const Eigen::Vector2f side = sign * ((part == 0 ? 1.0F : 0.5F) * x + part * y);
        shape.sides.emplace_back(side.x(), side.y(), inner);
      }
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector2f cut = dice.direction().cast<float>();
      shape.sides.emplace_back(cut.x(), cut.y(),
                               static_cast<float>(0.2 + 0.7 * dice.uniform()) * inner);
    }
  }

  void add_stroke(const Eigen::Vector2f& from, const Eigen::Vector2f& to, double width_texels,
                  float log_level) {
    TextureShape shape;
    shape.center = 0.5F * (from + to);
    shape.half_axis = 0.5F * (to - from);
    shape.half_width = static_cast<float>(0.5 * width_texels);
    shape.reach = shape.half_axis.norm() + shape.half_width;
    shape.log_albedo = log_level;
    shapes_.push_back(std::move(shape));
  }

  void add_lines() {
    const auto count = static_cast<std::uint64_t>(options_.lines.per_m2 * area_m2());
    for (std::uint64_t i = 0; i < count; ++i) {
      Dice dice(random_, kLines, i);
      const Eigen::Vector2f center = position(dice, 0);
      const Eigen::Vector2d direction = dice.direction();
      const double length_m = dice.between(options_.lines.length_m);
      const Eigen::Vector2f half = (0.5 * scale_ * length_m * direction).cast<float>();
      add_stroke(center - half, center + half, options_.lines.width_m * scale_, log_albedo(dice));
    }
  }

  void add_text() {
    const auto count = static_cast<std::uint64_t>(options_.text.per_m2 * area_m2());
    std::uint64_t letter = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      Dice dice(random_, kText, i);
      const Eigen::Vector2f origin = position(dice, 0);
      const float level = log_albedo(dice);
      const double height = options_.text.height_m * scale_ * (0.6 + 0.8 * dice.uniform());
      const int lines = dice.between(options_.text.lines);
      for (int line = 0; line < lines; ++line) {
        const int letters = dice.between(options_.text.letters);
        for (int column = 0; column < letters; ++column) {
          const Eigen::Vector2d corner(0.75 * column * height, 1.7 * line * height);
          add_letter(origin + corner.cast<float>(), height, level, letter++);
        }
      }
    }
  }

  /// Two to four strokes between the nodes of a 2 x 3 lattice; now and then a blank.
  void add_letter(const Eigen::Vector2f& corner, double height, float level, std::uint64_t item) {
    Dice dice(random_, kLetters, item);
    if (dice.uniform() < 0.15) return;
    const auto node = [&] {
      const double y = 0.5 * dice.between(std::array{0, 2});
      const double x = 0.5 * dice.between(std::array{0, 1});
      const Eigen::Vector2d lattice(x, y);
      return Eigen::Vector2f(corner + (height * lattice).cast<float>());
    };
    const int strokes = dice.between(std::array{2, 4});
    for (int i = 0; i < strokes; ++i) {
      const Eigen::Vector2f to = node();
      const Eigen::Vector2f from = node();
      add_stroke(from, to, 0.14 * height, level);
    }
  }

  void add_noise() {
    const auto& [wavelength, strength] = options_.noise;
    double total = 0;
    std::vector<std::pair<double, double>> octaves;  // wavelength [texel], weight
    for (double length = wavelength[1]; length >= wavelength[0]; length /= 2) {
      octaves.emplace_back(length * scale_, length);
      total += length;
    }
    for (std::size_t i = 0; i < octaves.size(); ++i)
      add_octave(kNoise + i, octaves[i].first, strength * octaves[i].second / total);
  }

  /// Value noise: random values on a lattice, smoothly interpolated.
  void add_octave(std::uint64_t stream, double wavelength, double amplitude) {
    const double step = 1 / std::max(wavelength, 2.0);
    const int columns = static_cast<int>(width_ * step) + 2;
    const int rows = static_cast<int>(height_ * step) + 2;
    ImageF lattice(columns, rows);
    for (std::size_t i = 0; i < lattice.size(); ++i)
      lattice.data()[i] = static_cast<float>(amplitude * (2 * random_.uniform(stream, i) - 1));
    const auto cell = [&](int texel) {
      const double x = texel * step;
      const double f = x - std::floor(x);
      return std::pair{static_cast<int>(x), static_cast<float>(f * f * (3 - 2 * f))};
    };
    std::vector<std::pair<int, float>> across;
    for (int x = 0; x < width_; ++x) across.push_back(cell(x));
    parallel_for(
        static_cast<std::size_t>(height_),
        [&](std::size_t row) {
          const auto [j, fy] = cell(static_cast<int>(row));
          float* texels = &image_(0, static_cast<int>(row));
          for (const auto& [i, fx] : across) {
            const float top = lattice(i, j) + fx * (lattice(i + 1, j) - lattice(i, j));
            const float bottom =
                lattice(i, j + 1) + fx * (lattice(i + 1, j + 1) - lattice(i, j + 1));
            *texels++ += top + fy * (bottom - top);
          }
        },
        32);
  }

  void expose() {
    const auto low = static_cast<float>(log_dark_);
    const auto high = static_cast<float>(log_light_);
    parallel_for(
        static_cast<std::size_t>(height_),
        [&](std::size_t row) {
          float* texels = &image_(0, static_cast<int>(row));
          for (int x = 0; x < width_; ++x) texels[x] = std::exp(std::clamp(texels[x], low, high));
        },
        32);
  }

  const TextureOptions& options_;
  Random random_;
  double scale_;  ///< [texel/m]
  int width_, height_;
  double log_dark_, log_light_;
  ImageF image_;
  std::vector<TextureShape> shapes_;
};

}  // namespace

void describe(config::Fields& fields, TextureOptions& options) {
  fields
      .value("size_m", options.size_m,
             "Width and height of the surface that the texture covers, in metres.")
      .above(0);
  fields.value("texels_per_m", options.texels_per_m, "Resolution, in texels per metre.").above(0);
  fields
      .value("seed", options.seed,
             "Seed; another seed gives another texture with the same statistics.")
      .at_least(0);
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

ImageF generate_texture(const TextureOptions& options) {
  config::check(options);
  return Generator(options).run();
}

}  // namespace saccade
