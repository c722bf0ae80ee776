#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/scene/texture/texture_generator.h"
#include "simulator/scene/world/world_texture.h"

namespace saccade {
namespace {

constexpr int kSheets = 3;
/// Texels of a sheet's side: three sheets with their pyramids take about 100 MB.
constexpr int kSide = 2048;

std::vector<WorldSheet> generated(WorldTextureRequest& request, TextureOptions options,
                                  double texels_per_m) {
  std::vector<WorldSheet> sheets;
  options.texels_per_m = texels_per_m;
  options.size_m.fill(kSide / texels_per_m);
  for (int i = 0; i < kSheets; ++i) {
    options.seed = request.dice.seed();
    sheets.push_back({generate_texture(options), options.size_m[0]});
  }
  return sheets;
}

/// Shapes, lines and text of all kinds.
TextureOptions mixed_shapes(std::array<double, 2> albedo) {
  TextureOptions options;
  options.albedo = albedo;
  options.edge_texels = 1;
  options.shapes = {.diameter_m = {0.02, 0.8}, .coverage = 3, .opacity = {0.6, 1}, .leaves = 0.1};
  options.lines = {.per_m2 = 5, .length_m = {0.1, 0.8}, .width_m = 0.005};
  options.text = {.per_m2 = 1.5, .height_m = 0.03, .lines = {1, 5}, .letters = {4, 16}};
  options.noise = {.wavelength_m = {0.02, 0.5}, .strength = 0.03};
  return options;
}

/// Pushes the logarithm of an albedo towards the ends of its range, so that neighbours are dark and
/// light rather than two greys.
void push_apart(ImageF& albedo, double dark, double light) {
  const double middle = 0.5 * (std::log(dark) + std::log(light));
  const double half = 0.5 * (std::log(light) - std::log(dark));
  for (float& value : albedo.pixels()) {
    double x = (std::log(static_cast<double>(value)) - middle) / half;
    // Rises from -1 to 1 with level ends: the range stays as it is.
    for (int i = 0; i < 2; ++i) x = std::clamp(0.5 * x * (3 - x * x), -1.0, 1.0);
    value = static_cast<float>(std::exp(middle + half * x));
  }
}

/// Fills a rectangle that goes on at the opposite border.
void fill(ImageF& image, int x0, int y0, int width, int height, float value) {
  for (int y = y0; y < y0 + height; ++y) {
    float* row = &image(0, y % kSide);
    for (int x = x0; x < x0 + width; ++x) row[x % kSide] = value;
  }
}

ImageF rectangles(WorldDice dice) {
  constexpr double kSmallest = 6, kLargest = 420;  // [texel]
  constexpr int kRectangles = 60'000;
  constexpr double kDark = 0.05, kLight = 0.9;
  ImageF image(kSide, kSide);
  image.fill(static_cast<float>(dice.log_between(kDark, kLight)));
  // The density of sizes falls as size^-3: as natural scenes, all scales look alike.
  const double shrink = 1 - std::pow(kSmallest / kLargest, 2);
  for (int i = 0; i < kRectangles; ++i) {
    const double size = kSmallest / std::sqrt(1 - dice.uniform() * shrink);
    const int width = std::max(2, static_cast<int>(size * dice.between(0.25, 1)));
    const int height = std::max(2, static_cast<int>(size * dice.between(0.25, 1)));
    const int x = dice.integer(0, kSide - 1), y = dice.integer(0, kSide - 1);
    fill(image, x, y, width, height, static_cast<float>(dice.log_between(kDark, kLight)));
  }
  return image;
}

}  // namespace

std::vector<WorldSheet> make_rectangles(WorldTextureRequest& request) {
  std::vector<WorldSheet> sheets;
  for (int i = 0; i < kSheets; ++i)
    sheets.push_back({rectangles({request.dice.seed(), 0}), kSide / 640.0});
  return sheets;
}

std::vector<WorldSheet> make_print(WorldTextureRequest& request) {
  TextureOptions options;
  options.albedo = {0.05, 0.85};
  options.edge_texels = 1;
  options.shapes = {.diameter_m = {0.2, 0.9}, .coverage = 0.8, .opacity = {0.9, 1}, .leaves = 0};
  options.lines = {.per_m2 = 12, .length_m = {0.1, 0.8}, .width_m = 0.002};
  options.text = {.per_m2 = 45, .height_m = 0.016, .lines = {3, 12}, .letters = {8, 30}};
  options.noise = {.wavelength_m = {0.05, 0.5}, .strength = 0.03};
  return generated(request, options, 800);
}

std::vector<WorldSheet> make_faint(WorldTextureRequest& request) {
  return generated(request, mixed_shapes({0.425, 0.575}), 640);
}

std::vector<WorldSheet> make_contrast(WorldTextureRequest& request) {
  constexpr double kDark = 0.085, kLight = 0.85;
  std::vector<WorldSheet> sheets = generated(request, mixed_shapes({kDark, kLight}), 640);
  for (WorldSheet& sheet : sheets) push_apart(sheet.albedo, kDark, kLight);
  return sheets;
}

std::vector<WorldSheet> make_leaves(WorldTextureRequest& request) {
  TextureOptions options;
  options.albedo = {0.04, 0.9};
  options.edge_texels = 1.2;
  options.shapes = {.diameter_m = {0.05, 0.9}, .coverage = 2.2, .opacity = {0.8, 1}, .leaves = 1};
  options.lines.per_m2 = 0;
  options.text.per_m2 = 0;
  options.noise = {.wavelength_m = {0.02, 0.4}, .strength = 0.1};
  return generated(request, options, 640);
}

}  // namespace saccade
