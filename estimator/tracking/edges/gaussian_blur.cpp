#include "estimator/tracking/edges/gaussian_blur.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace saccade {
namespace {

/// out = w[0] in[0] + sum_k w[k] (in[-k step] + in[k step]) for `count` neighbouring pixels. The
/// radius is a template argument so that the sum stays in registers.
template <int kRadius>
void filter_line(const float* in, std::ptrdiff_t step, const float* w, float* __restrict out,
                 int count) {
  for (int i = 0; i < count; ++i) {
    float sum = w[0] * in[i];
    for (int k = 1; k <= kRadius; ++k) sum += w[k] * (in[i - k * step] + in[i + k * step]);
    out[i] = sum;
  }
}

using Filter = void (*)(const float*, std::ptrdiff_t, const float*, float* __restrict, int);

constexpr Filter kFilters[] = {filter_line<0>, filter_line<1>, filter_line<2>, filter_line<3>,
                               filter_line<4>, filter_line<5>, filter_line<6>, filter_line<7>};

}  // namespace

PaddedImage::PaddedImage(int image_width, int image_height, int image_margin)
    : width(image_width),
      height(image_height),
      margin(image_margin),
      stride(image_width + 2 * image_margin),
      pixels(static_cast<std::size_t>(stride) *
             static_cast<std::size_t>(image_height + 2 * image_margin)) {}

void PaddedImage::clear() { std::fill(pixels.begin(), pixels.end(), 0.0F); }

GaussianBlur::GaussianBlur(int size, double sigma) : radius_(size / 2) {
  SACCADE_CHECK(size >= 1 && size <= 15 && size % 2 == 1 && sigma > 0);
  double sum = 0;
  for (int k = 0; k <= radius_; ++k) {
    const double w = std::exp(-k * k / (2 * sigma * sigma));
    taps_.push_back(static_cast<float>(w));
    sum += k == 0 ? w : 2 * w;
  }
  for (float& w : taps_) w = static_cast<float>(static_cast<double>(w) / sum);
}

void GaussianBlur::apply(const PaddedImage& in, PaddedImage& out) {
  SACCADE_CHECK(in.margin >= radius_ && in.stride == out.stride && in.margin == out.margin);
  const Filter filter = kFilters[radius_];
  line_.resize(static_cast<std::size_t>(in.stride));
  float* line = line_.data() + in.margin;
  for (int y = 0; y < in.height; ++y) {
    filter(in.row(y) - radius_, in.stride, taps_.data(), line - radius_, in.width + 2 * radius_);
    filter(line, 1, taps_.data(), out.row(y), in.width);
  }
}

}  // namespace saccade
