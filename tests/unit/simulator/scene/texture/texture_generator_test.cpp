#include "simulator/scene/texture/texture_generator.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "core/config/config.h"
#include "core/error.h"
#include "core/process/parallel.h"

namespace saccade {
namespace {

TextureOptions small_texture() {
  TextureOptions options;
  options.size_m = {1.2, 0.8};
  return options;
}

double mean_difference(const ImageF& image, int dx, int dy) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y + dy < image.height(); ++y)
    for (int x = 0; x + dx < image.width(); ++x, ++count)
      sum += std::abs(std::log(image(x, y)) - std::log(image(x + dx, y + dy)));
  return sum / count;
}

TEST(TextureGenerator, HasTheStatedSizeAndRange) {
  const ImageF image = generate_texture(small_texture());
  EXPECT_EQ(image.width(), 300);
  EXPECT_EQ(image.height(), 200);
  const auto [low, high] = std::ranges::minmax_element(image.pixels());
  EXPECT_GE(*low, 0.0499F);
  EXPECT_LE(*high, 0.9501F);
  EXPECT_GT(*high / *low, 5);
}

TEST(TextureGenerator, IsTheSameForAnyNumberOfThreads) {
  set_thread_count(1);
  const ImageF one = generate_texture(small_texture());
  set_thread_count(4);
  const ImageF four = generate_texture(small_texture());
  set_thread_count(0);
  EXPECT_EQ(one, four);
}

TEST(TextureGenerator, SeedsGiveDifferentTextures) {
  TextureOptions other = small_texture();
  other.seed = 2;
  EXPECT_NE(generate_texture(small_texture()), generate_texture(other));
}

TEST(TextureGenerator, HasStructureAtEveryScaleAndDoesNotRepeat) {
  const ImageF image = generate_texture(small_texture());
  double last = 0;
  for (const int step : {1, 4, 16, 64}) {
    const double difference = mean_difference(image, step, 0);
    EXPECT_GT(difference, 1.15 * last) << step;
    last = difference;
  }
  for (int shift = 20; shift < 150; shift += 5) EXPECT_GT(mean_difference(image, shift, 0), 0.3);
}

TEST(TextureGenerator, EdgesBlendOverMoreThanATexel) {
  TextureOptions options = small_texture();
  options.noise.strength = 0;
  const ImageF image = generate_texture(options);
  double largest = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x + 1 < image.width(); ++x)
      largest = std::max(largest, std::abs(std::log(static_cast<double>(image(x + 1, y))) -
                                           std::log(static_cast<double>(image(x, y)))));
  EXPECT_LT(largest, 0.95 * std::log(0.95 / 0.05));
}

TEST(TextureGenerator, LeavesAreAnotherTextureOfTheSameKind) {
  TextureOptions leaves = small_texture();
  leaves.shapes.leaves = 1;
  const ImageF image = generate_texture(leaves);
  EXPECT_NE(image, generate_texture(small_texture()));
  EXPECT_GT(mean_difference(image, 16, 0), 1.15 * mean_difference(image, 1, 0));
}

TEST(TextureGenerator, EmptyLayersLeaveAnEvenSurface) {
  TextureOptions options = small_texture();
  options.shapes.coverage = 0;
  options.lines.per_m2 = 0;
  options.text.per_m2 = 0;
  options.noise.strength = 0;
  const ImageF image = generate_texture(options);
  EXPECT_EQ(image, ImageF(image.width(), image.height(), image(0, 0)));
}

TEST(TextureGenerator, OptionsOutOfRangeAreErrors) {
  TextureOptions options = small_texture();
  options.albedo = {0.9, 0.1};
  EXPECT_THROW(static_cast<void>(generate_texture(options)), InputError);
  options = small_texture();
  options.texels_per_m = 1e6;
  EXPECT_THROW(static_cast<void>(generate_texture(options)), InputError);
}

TEST(TextureGenerator, OptionsPrintWhatTheyRead) {
  const std::string printed = config::print(small_texture());
  const auto again = config::read<TextureOptions>(config::parse(printed, "printed.texture.yaml"));
  EXPECT_EQ(config::print(again), printed);
}

}  // namespace
}  // namespace saccade
