#include "simulator/scene/texture/texture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

namespace saccade {
namespace {

/// Two neighbouring texels and how far the position lies towards the second.
struct Neighbours {
  int first, second;
  double fraction;
};

Neighbours neighbours(double x, int size, Wrap wrap) {
  const double period = size;
  if (wrap == Wrap::kRepeat) {
    double inside = x - period * std::floor(x / period);
    if (inside >= period) inside = 0;  // a tiny negative x rounds up to the period
    const int first = static_cast<int>(inside);
    return {first, first + 1 == size ? 0 : first + 1, inside - first};
  }
  if (wrap == Wrap::kMirror) {
    const double edge = x + 0.5;  // mirrored about texel edges, not centres
    const double folded = edge - 2 * period * std::floor(edge / (2 * period));
    x = std::min(folded, 2 * period - folded) - 0.5;
  }
  const double inside = std::clamp(x, 0.0, period - 1);
  const int first = std::min(static_cast<int>(inside), size - 2);
  return {first, first + 1, inside - first};
}

/// The texel that shows at index `i` of an endless texture.
int wrapped(std::int64_t i, int size, Wrap wrap) {
  if (wrap == Wrap::kClamp) return static_cast<int>(std::clamp<std::int64_t>(i, 0, size - 1));
  const std::int64_t period = wrap == Wrap::kMirror ? 2 * std::int64_t{size} : size;
  const std::int64_t inside = (i % period + period) % period;
  return static_cast<int>(inside < size ? inside : period - 1 - inside);
}

/// Stored texels first..last, borders included.
struct IndexRange {
  int first, last;
};

/// Texels that at_texel() reads over from..to; all of them where the range crosses the border of a
/// repeated or mirrored texture.
IndexRange inside_indices(double from, double to, int size, Wrap wrap) {
  const IndexRange all{0, size - 1};
  if (!(to - from < size) || !(std::abs(from) < 1e15)) return all;
  const auto first = static_cast<std::int64_t>(std::floor(from));
  const auto last = static_cast<std::int64_t>(std::floor(to)) + 1;
  if (first >= 0 && last < size) return {static_cast<int>(first), static_cast<int>(last)};
  const int a = wrapped(first, size, wrap);
  const int b = wrapped(last, size, wrap);
  if (wrap == Wrap::kClamp) return {a, b};
  if (wrap == Wrap::kRepeat) return b - a == last - first ? IndexRange{a, b} : all;
  const IndexRange folded{std::min(a, b), std::max(a, b)};
  return folded.last - folded.first == last - first ? folded : all;
}

TexelRange hull(const TexelRange& a, const TexelRange& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

/// Bilinear interpolation needs two texels each way.
ImageF widened(ImageF image) {
  if (image.width() >= 2 && image.height() >= 2) return image;
  ImageF wide(std::max(image.width(), 2), std::max(image.height(), 2));
  for (int y = 0; y < wide.height(); ++y)
    for (int x = 0; x < wide.width(); ++x)
      wide(x, y) = image(std::min(x, image.width() - 1), std::min(y, image.height() - 1));
  return wide;
}

/// The fraction of texel `i` that lies in from..to.
double overlap(double from, double to, int i) {
  return std::max(0.0, std::min(to, i + 1.0) - std::max(from, static_cast<double>(i)));
}

/// Means over width x height equal parts of the image, also where they cut texels.
ImageF shrunk(const ImageF& image, int width, int height) {
  const double step_x = static_cast<double>(image.width()) / width;
  const double step_y = static_cast<double>(image.height()) / height;
  ImageF means(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (int j = static_cast<int>(y * step_y);
           j < std::min((y + 1) * step_y, 1.0 * image.height()); ++j)
        for (int i = static_cast<int>(x * step_x);
             i < std::min((x + 1) * step_x, 1.0 * image.width()); ++i)
          sum += overlap(x * step_x, (x + 1) * step_x, i) *
                 overlap(y * step_y, (y + 1) * step_y, j) * static_cast<double>(image(i, j));
      means(x, y) = static_cast<float>(sum / (step_x * step_y));
    }
  return means;
}

/// A texel coordinate of one picture in another of the same extent.
double rescaled(double x, int from, int to) { return (x + 0.5) * to / from - 0.5; }

}  // namespace

struct Texture::Pyramid {
  std::once_flag once;
  std::vector<Texture> levels;
};

Texture::Texture(ImageF image, Wrap wrap_u, Wrap wrap_v)
    : image_(widened(std::move(image))),
      pyramid_(std::make_shared<Pyramid>()),
      wrap_u_(wrap_u),
      wrap_v_(wrap_v) {
  SACCADE_CHECK(image_.width() >= 2 && image_.height() >= 2);
  build_ranges();
}

void Texture::build_ranges() {
  const auto halve = [](int width, int height, const auto& at) {
    Image<TexelRange> blocks((width + 1) / 2, (height + 1) / 2);
    for (int y = 0; y < blocks.height(); ++y)
      for (int x = 0; x < blocks.width(); ++x) {
        TexelRange range = at(2 * x, 2 * y);
        for (int j = 2 * y; j < std::min(2 * y + 2, height); ++j)
          for (int i = 2 * x; i < std::min(2 * x + 2, width); ++i) range = hull(range, at(i, j));
        blocks(x, y) = range;
      }
    return blocks;
  };
  ranges_.push_back(halve(width(), height(), [&](int i, int j) {
    return TexelRange{image_(i, j), image_(i, j)};
  }));
  while (ranges_.back().width() > 1 || ranges_.back().height() > 1) {
    const Image<TexelRange>& finer = ranges_.back();
    ranges_.push_back(
        halve(finer.width(), finer.height(), [&](int i, int j) { return finer(i, j); }));
  }
}

std::array<float, 4> Texture::cell_across_border(std::int64_t i, std::int64_t j) const {
  const int x0 = wrapped(i, width(), wrap_u_);
  const int x1 = wrapped(i + 1, width(), wrap_u_);
  const int y0 = wrapped(j, height(), wrap_v_);
  const int y1 = wrapped(j + 1, height(), wrap_v_);
  return {image_(x0, y0), image_(x1, y0), image_(x0, y1), image_(x1, y1)};
}

TexelRange Texture::range_across_border(const TexelBox& box) const {
  const IndexRange across = inside_indices(box.x0, box.x1, width(), wrap_u_);
  const IndexRange down = inside_indices(box.y0, box.y1, height(), wrap_v_);
  return range_within(across.first, across.last, down.first, down.last);
}

TexelRange Texture::range_within(int i0, int i1, int j0, int j1) const {
  constexpr unsigned kMax = 4;  // values examined per side
  const auto extent = static_cast<unsigned>(std::max(i1 - i0, j1 - j0));
  const int level = std::bit_width(extent / kMax);
  TexelRange range{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
  if (level == 0) {
    for (int j = j0; j <= j1; ++j) {
      const float* row = &image_(0, j);
      for (int i = i0; i <= i1; ++i) range = hull(range, {row[i], row[i]});
    }
    return range;
  }
  const Image<TexelRange>& blocks = ranges_[static_cast<std::size_t>(level - 1)];
  for (int j = j0 >> level; j <= j1 >> level; ++j)
    for (int i = i0 >> level; i <= i1 >> level; ++i) range = hull(range, blocks(i, j));
  return range;
}

const std::vector<Texture>& Texture::coarser() const {
  std::call_once(pyramid_->once, [this] {
    ImageF finer = image_;
    while (finer.width() > 1 || finer.height() > 1) {
      finer = shrunk(finer, std::max(finer.width() / 2, 1), std::max(finer.height() / 2, 1));
      pyramid_->levels.emplace_back(finer, wrap_u_, wrap_v_);
    }
  });
  return pyramid_->levels;
}

double Texture::at_texel(double x, double y, double level) const {
  if (!(level > 0)) return at_texel(x, y);
  const std::vector<Texture>& levels = coarser();
  const double inside = std::min(level, static_cast<double>(levels.size()));
  const auto at_level = [&](std::size_t k) {
    if (k == 0) return at_texel(x, y);
    const Texture& texture = levels[k - 1];
    return texture.at_texel(rescaled(x, width(), texture.width()),
                            rescaled(y, height(), texture.height()));
  };
  const auto finer = static_cast<std::size_t>(inside);
  const double fraction = inside - static_cast<double>(finer);
  const double value = at_level(finer);
  return fraction == 0 ? value : value + fraction * (at_level(finer + 1) - value);
}

TexelRange Texture::range(const TexelBox& box, double low_level, double high_level) const {
  if (!(high_level > 0)) return range(box);
  const std::vector<Texture>& levels = coarser();
  const auto last = static_cast<double>(levels.size());
  const auto first_level = static_cast<std::size_t>(std::clamp(std::floor(low_level), 0.0, last));
  const auto last_level = static_cast<std::size_t>(std::min(std::ceil(high_level), last));
  const auto at_level = [&](std::size_t k) {
    if (k == 0) return range(box);
    const Texture& texture = levels[k - 1];
    return texture.range({rescaled(box.x0, width(), texture.width()),
                          rescaled(box.x1, width(), texture.width()),
                          rescaled(box.y0, height(), texture.height()),
                          rescaled(box.y1, height(), texture.height())});
  };
  TexelRange all = at_level(first_level);
  for (std::size_t k = first_level + 1; k <= last_level; ++k) all = hull(all, at_level(k));
  return all;
}

double Texture::across_border(double x, double y) const {
  const Neighbours column = neighbours(x, width(), wrap_u_);
  const Neighbours row = neighbours(y, height(), wrap_v_);
  const auto along = [&](int j) {
    const double a = image_(column.first, j);
    return a + column.fraction * (image_(column.second, j) - a);
  };
  const double top = along(row.first);
  return top + row.fraction * (along(row.second) - top);
}

}  // namespace saccade
