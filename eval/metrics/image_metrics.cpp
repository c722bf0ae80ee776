#include "eval/metrics/image_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/check.h"

namespace saccade {
namespace {

constexpr std::size_t kFewest = 100;  ///< pixels of a view that is scored
constexpr int kRadius = 5;
constexpr double kSigma = 1.5;

/// First and second moments of two series, about the values of a first pair: what is constant
/// has a variance of 0, and little is lost where the mean is large against the standard deviation.
class SeriesMoments {
 public:
  SeriesMoments(double first_a, double first_b) : first_a_(first_a), first_b_(first_b) {}

  void add(double a, double b, double weight = 1) {
    const double x = a - first_a_, y = b - first_b_;
    n_ += weight;
    a_ += weight * x;
    b_ += weight * y;
    aa_ += weight * x * x;
    ab_ += weight * x * y;
    bb_ += weight * y * y;
  }
  [[nodiscard]] double weight() const { return n_; }
  [[nodiscard]] double mean_a() const { return first_a_ + a_ / n_; }
  [[nodiscard]] double mean_b() const { return first_b_ + b_ / n_; }
  [[nodiscard]] double var_a() const { return std::max(aa_ / n_ - a_ / n_ * (a_ / n_), 0.0); }
  [[nodiscard]] double var_b() const { return std::max(bb_ / n_ - b_ / n_ * (b_ / n_), 0.0); }
  [[nodiscard]] double covariance() const { return ab_ / n_ - a_ / n_ * (b_ / n_); }
  [[nodiscard]] double correlation() const {
    const double product = var_a() * var_b();
    return product > 0 ? covariance() / std::sqrt(product) : 0;
  }

 private:
  double first_a_, first_b_;
  double n_ = 0, a_ = 0, b_ = 0, aa_ = 0, ab_ = 0, bb_ = 0;
};

SeriesMoments moments_of(const ImageF& a, const ImageF& b, const ImageU8& mask) {
  std::optional<SeriesMoments> moments;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask.pixels()[i] == 0) continue;
    const auto x = static_cast<double>(a.pixels()[i]), y = static_cast<double>(b.pixels()[i]);
    if (!moments) moments.emplace(x, y);
    moments->add(x, y);
  }
  return moments.value_or(SeriesMoments(0, 0));
}

double range_of(const ImageF& image, const ImageU8& mask) {
  float low = std::numeric_limits<float>::infinity();
  float high = -low;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask.pixels()[i] == 0) continue;
    low = std::min(low, image.pixels()[i]);
    high = std::max(high, image.pixels()[i]);
  }
  return static_cast<double>(high) - static_cast<double>(low);
}

std::array<double, kRadius + 1> window_weights() {
  std::array<double, kRadius + 1> weights{};
  for (int k = 0; k <= kRadius; ++k)
    weights[static_cast<std::size_t>(k)] = std::exp(-k * k / (2 * kSigma * kSigma));
  return weights;
}

SeriesMoments window_around(const ImageF& a, const ImageF& b, const ImageU8& mask, int x, int y) {
  static const auto weights = window_weights();
  SeriesMoments moments(static_cast<double>(a(x, y)), static_cast<double>(b(x, y)));
  for (int v = std::max(y - kRadius, 0); v <= std::min(y + kRadius, a.height() - 1); ++v)
    for (int u = std::max(x - kRadius, 0); u <= std::min(x + kRadius, a.width() - 1); ++u)
      if (mask(u, v) != 0)
        moments.add(static_cast<double>(a(u, v)), static_cast<double>(b(u, v)),
                    weights[static_cast<std::size_t>(std::abs(u - x))] *
                        weights[static_cast<std::size_t>(std::abs(v - y))]);
  return moments;
}

/// Gradients next to what is not on the mask mean nothing.
ImageU8 inner(const ImageU8& mask) {
  ImageU8 result = mask;
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x)
      for (const auto [dx, dy] : {std::array{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const int u = std::clamp(x + dx, 0, mask.width() - 1);
        const int v = std::clamp(y + dy, 0, mask.height() - 1);
        if (mask(u, v) == 0) result(x, y) = 0;
      }
  return result;
}

ImageF magnitude_of(const ImageComparison& c) {
  if (c.gradient_x.empty()) return gradient_size(c.estimate);
  ImageF result = c.gradient_x;
  for (std::size_t i = 0; i < result.size(); ++i)
    result.pixels()[i] = std::hypot(c.gradient_x.pixels()[i], c.gradient_y.pixels()[i]);
  return result;
}

}  // namespace

double structural_similarity(const ImageF& a, const ImageF& b, const ImageU8& mask) {
  SACCADE_CHECK(a.size() == b.size() && a.size() == mask.size());
  const double range = range_of(a, mask);
  const double c1 = std::pow(0.01 * range, 2);
  const double c2 = std::pow(0.03 * range, 2);
  double sum = 0;
  std::size_t count = 0;
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x) {
      if (mask(x, y) == 0) continue;
      const SeriesMoments m = window_around(a, b, mask, x, y);
      sum +=
          (2 * m.mean_a() * m.mean_b() + c1) * (2 * m.covariance() + c2) /
          ((m.mean_a() * m.mean_a() + m.mean_b() * m.mean_b() + c1) * (m.var_a() + m.var_b() + c2));
      ++count;
    }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

std::optional<ImageScores> score_image(const ImageComparison& c) {
  SACCADE_CHECK(c.estimate.size() == c.truth.size() && c.truth.size() == c.mask.size());
  const SeriesMoments m = moments_of(c.estimate, c.truth, c.mask);
  if (m.weight() < kFewest || !(m.var_b() > 0)) return std::nullopt;
  ImageScores scores;
  scores.observed = c.observed;
  scores.scale = m.var_a() > 0 ? m.covariance() / m.var_a() : 0;
  scores.offset = m.mean_b() - scores.scale * m.mean_a();
  scores.pearson = m.correlation();
  scores.mse = m.var_b() * (1 - scores.pearson * scores.pearson);
  scores.fitted = c.estimate;
  for (float& value : scores.fitted.pixels())
    value = static_cast<float>(scores.scale * static_cast<double>(value) + scores.offset);
  scores.ssim = structural_similarity(c.truth, scores.fitted, c.mask);
  scores.gradient_pearson =
      moments_of(magnitude_of(c), gradient_size(c.truth), inner(c.mask)).correlation();
  return scores;
}

ImageF gradient_size(const ImageF& image) {
  ImageF result(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const int left = std::max(x - 1, 0), right = std::min(x + 1, image.width() - 1);
      const int top = std::max(y - 1, 0), bottom = std::min(y + 1, image.height() - 1);
      const float dx = (image(right, y) - image(left, y)) / static_cast<float>(right - left);
      const float dy = (image(x, bottom) - image(x, top)) / static_cast<float>(bottom - top);
      result(x, y) = std::hypot(dx, dy);
    }
  return result;
}

void set_image_scores(Metrics& metrics, std::span<const std::optional<ImageScores>> views) {
  const auto mean = [&](const std::string& key, const auto& value_of) {
    double sum = 0;
    std::size_t count = 0;
    for (const auto& view : views)
      if (view) {
        sum += value_of(*view);
        ++count;
      }
    metrics.set("reconstruction." + key,
                count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt);
  };
  mean("ssim", [](const ImageScores& s) { return s.ssim; });
  mean("pearson", [](const ImageScores& s) { return s.pearson; });
  mean("mse", [](const ImageScores& s) { return s.mse; });
  mean("rmse_log", [](const ImageScores& s) { return std::sqrt(s.mse); });
  mean("gradient_pearson", [](const ImageScores& s) { return s.gradient_pearson; });
  mean("observed", [](const ImageScores& s) { return s.observed; });
  mean("fit.scale", [](const ImageScores& s) { return s.scale; });
  mean("fit.offset", [](const ImageScores& s) { return s.offset; });
  std::optional<double> ssim, pearson;
  for (const auto& view : views)
    if (view) {
      ssim = std::min(ssim.value_or(1), view->ssim);
      pearson = std::min(pearson.value_or(1), view->pearson);
    }
  metrics.set("reconstruction.worst.ssim", ssim);
  metrics.set("reconstruction.worst.pearson", pearson);
  metrics.set("reconstruction.views", static_cast<double>(views.size()));
}

}  // namespace saccade
