#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/process/parallel.h"
#include "simulator/scene/mesh/file_source.h"
#include "simulator/scene/texture/picture.h"
#include "simulator/scene/world/world_pictures.h"
#include "simulator/scene/world/world_texture.h"

namespace saccade {
namespace {

/// Of both, print is not darker and paper not lighter than this.
constexpr float kInk = 0.03F, kPaper = 0.9F;

Picture read_picture(const WorldPicture& picture, WorldTextureRequest& request) {
  const std::string problem = missing_picture_problem(picture);
  const std::optional<Bytes> bytes = FileSource().read(picture.file);
  if (!problem.empty()) throw InputError("scene.world.texture", problem);
  if (!bytes) throw InputError(picture.file.string(), "cannot be read");
  return decode_picture(*bytes, picture.file.string(), request.remarks, {1, 1, 1}, request.channel);
}

/// `count` different ones of so many, in an order by chance.
std::vector<std::size_t> draw_some(WorldDice& dice, std::size_t count, std::size_t of) {
  std::vector<std::size_t> all(of);
  for (std::size_t i = 0; i < of; ++i) all[i] = i;
  for (std::size_t i = 0; i < count; ++i)
    std::swap(
        all[i],
        all[static_cast<std::size_t>(dice.integer(static_cast<int>(i), static_cast<int>(of) - 1))]);
  all.resize(count);
  return all;
}

/// Means over squares of `factor` texels; what is left at the borders goes.
ImageF shrunk(const ImageF& image, int factor) {
  ImageF small(image.width() / factor, image.height() / factor);
  parallel_for(static_cast<std::size_t>(small.height()), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < small.width(); ++x) {
      float sum = 0;
      for (int j = 0; j < factor; ++j)
        for (int i = 0; i < factor; ++i) sum += image(factor * x + i, factor * y + j);
      small(x, y) = sum / static_cast<float>(factor * factor);
    }
  });
  return small;
}

/// As a print shows it: black is ink, the lightest hundredth at most paper, and the mean about that
/// of a middle grey.
void print_as_poster(ImageF& image) {
  std::vector<float> some;
  double sum = 0;
  for (std::size_t i = 0; i < image.size(); i += 97) {
    some.push_back(image.data()[i]);
    sum += static_cast<double>(some.back());
  }
  const auto high = some.begin() + static_cast<std::ptrdiff_t>(some.size() * 99 / 100);
  std::nth_element(some.begin(), high, some.end());
  constexpr float kDarkest = 0.05F;  // of a picture that is dark all over
  constexpr double kGrey = 0.22;
  const auto mean = static_cast<float>(sum / static_cast<double>(some.size()));
  const float gain =
      std::min(1 / std::max(*high, kDarkest), static_cast<float>(kGrey) / std::max(mean, kDarkest));
  for (float& value : image.pixels()) value = kInk + (kPaper - kInk) * std::min(1.0F, gain * value);
}

/// What covers and how much, both of one size; light times opacity.
struct Cutting {
  ImageF light, opacity;
};

Cutting read_cutting(const WorldPicture& file, WorldTextureRequest& request) {
  constexpr int kLargest = 900;  // [texel]
  Picture picture = read_picture(file, request);
  if (picture.opacity.empty()) {
    picture.opacity = ImageF(picture.grey.width(), picture.grey.height());
    picture.opacity.fill(1);
  }
  for (std::size_t i = 0; i < picture.grey.size(); ++i)
    picture.grey.data()[i] =
        picture.opacity.data()[i] * (kInk + (kPaper - kInk) * picture.grey.data()[i]);
  const int factor =
      (std::max(picture.grey.width(), picture.grey.height()) + kLargest - 1) / kLargest;
  return {shrunk(picture.grey, factor), shrunk(picture.opacity, factor)};
}

/// Pastes a cutting, mirrored or not, with its corner there; what is beyond the borders goes.
void paste(ImageF& sheet, const Cutting& cutting, int x0, int y0, bool is_mirrored) {
  const int width = cutting.light.width(), height = cutting.light.height();
  for (int y = std::max(0, -y0); y < std::min(height, sheet.height() - y0); ++y)
    for (int x = std::max(0, -x0); x < std::min(width, sheet.width() - x0); ++x) {
      const int from = is_mirrored ? width - 1 - x : x;
      float& value = sheet(x0 + x, y0 + y);
      value = value * (1 - cutting.opacity(from, y)) + cutting.light(from, y);
    }
}

}  // namespace

std::vector<WorldSheet> make_photographs(WorldTextureRequest& request) {
  constexpr std::size_t kSheets = 5;
  constexpr int kLargest = 2600;  // [texel]: five of them take 200 MB with their pyramids
  const std::span<const WorldPicture> all = world_photographs();
  std::vector<WorldSheet> sheets;
  for (const std::size_t i : draw_some(request.dice, kSheets, all.size())) {
    ImageF image = read_picture(all[i], request).grey;
    const int factor = (std::max(image.width(), image.height()) + kLargest - 1) / kLargest;
    if (factor > 1) image = shrunk(image, factor);
    print_as_poster(image);
    const double texels_per_m = request.dice.between(550, 900);
    const double width_m = image.width() / texels_per_m;
    sheets.push_back({std::move(image), width_m});
  }
  return sheets;
}

std::vector<WorldSheet> make_drawings(WorldTextureRequest& request) {
  constexpr std::size_t kDrawings = 20;
  constexpr int kSheets = 3, kSide = 2048, kPasted = 60;
  WorldDice& dice = request.dice;
  const std::span<const WorldPicture> all = world_drawings();
  std::vector<Cutting> cuttings;
  for (const std::size_t i : draw_some(dice, kDrawings, all.size())) {
    cuttings.push_back(read_cutting(all[i], request));
    const Cutting& large = cuttings.back();
    cuttings.push_back({shrunk(large.light, 2), shrunk(large.opacity, 2)});
  }
  std::vector<WorldSheet> sheets;
  for (int k = 0; k < kSheets; ++k) {
    ImageF sheet(kSide, kSide);
    sheet.fill(static_cast<float>(dice.between(0.4, 0.85)));
    for (int i = 0; i < kPasted; ++i) {
      const auto which =
          static_cast<std::size_t>(dice.integer(0, static_cast<int>(cuttings.size()) - 1));
      const int x = dice.integer(-300, kSide - 100), y = dice.integer(-300, kSide - 100);
      paste(sheet, cuttings[which], x, y, dice.chance(0.5));
    }
    sheets.push_back({std::move(sheet), kSide / dice.between(550, 800)});
  }
  return sheets;
}

}  // namespace saccade
