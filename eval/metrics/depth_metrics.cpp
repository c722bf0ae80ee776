#include "eval/metrics/depth_metrics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>

#include "core/median.h"

namespace saccade {
namespace {

constexpr double kMaxDepthRatio = 1.1;  ///< of pixels on one surface
constexpr double kOutlier = 0.05;
constexpr double kDelta = 1.25;

DepthError error_of(const DepthPoint& point, double truth_m) {
  const double difference = point.depth_m - truth_m;
  return {point.depth_m, difference, std::abs(difference) / truth_m, point.sigma_m};
}

std::optional<DepthError> best_error(const DepthPoint& point, const ImageF& truth) {
  const auto x = static_cast<int>(std::lround(point.pixel.x()));
  const auto y = static_cast<int>(std::lround(point.pixel.y()));
  std::optional<DepthError> best;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, truth.height() - 1); ++v)
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, truth.width() - 1); ++u) {
      if (!(truth(u, v) > 0)) continue;
      const DepthError error = error_of(point, static_cast<double>(truth(u, v)));
      if (!best || error.relative < best->relative) best = error;
    }
  return best;
}

std::optional<double> depth_at(const ImageF& truth, const Eigen::Vector2d& pixel) {
  const BilinearCell<double> c(pixel.x(), pixel.y(), truth.width(), truth.height());
  const float corners[] = {truth(c.x0, c.y0), truth(c.x0 + 1, c.y0), truth(c.x0, c.y0 + 1),
                           truth(c.x0 + 1, c.y0 + 1)};
  const auto [low, high] = std::minmax_element(std::begin(corners), std::end(corners));
  if (*low > 0 && static_cast<double>(*high) <= kMaxDepthRatio * static_cast<double>(*low)) {
    const double weights[] = {(1 - c.fx) * (1 - c.fy), c.fx * (1 - c.fy), (1 - c.fx) * c.fy,
                              c.fx * c.fy};
    double inverse = 0;
    for (int i = 0; i < 4; ++i) inverse += weights[i] / static_cast<double>(corners[i]);
    return 1 / inverse;
  }
  const float nearest =
      truth(static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y())));
  if (nearest > 0) return static_cast<double>(nearest);
  return std::nullopt;
}

void count_edges(const ImageU8& found, const DepthTruth& truth, DepthErrors& errors) {
  for (int y = 0; y < found.height(); ++y)
    for (int x = 0; x < found.width(); ++x) {
      if (truth.edges(x, y) == 0) continue;
      ++errors.edge_pixels;
      if (found(x, y) != 0) ++errors.found_edge_pixels;
    }
}

/// The 3 x 3 pixels around a point.
void mark(ImageU8& found, const Eigen::Vector2d& pixel) {
  const auto x = static_cast<int>(std::lround(pixel.x()));
  const auto y = static_cast<int>(std::lround(pixel.y()));
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, found.height() - 1); ++v)
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, found.width() - 1); ++u) found(u, v) = 1;
}

std::optional<double> mean(std::span<const DepthError> errors,
                           const std::function<double(const DepthError&)>& value) {
  if (errors.empty()) return std::nullopt;
  double sum = 0;
  for (const DepthError& error : errors) sum += value(error);
  return sum / static_cast<double>(errors.size());
}

std::optional<double> fraction_within(std::span<const DepthError> errors, double sigmas) {
  std::size_t known = 0, within = 0;
  for (const DepthError& error : errors) {
    if (!error.sigma_m) continue;
    ++known;
    if (std::abs(error.difference_m) <= sigmas * *error.sigma_m) ++within;
  }
  if (known == 0) return std::nullopt;
  return static_cast<double>(within) / static_cast<double>(known);
}

std::optional<double> median_of(const std::vector<double>& values) {
  return values.empty() ? std::nullopt : std::optional(median(values));
}

void set_errors(Metrics& metrics, const std::string& prefix, std::span<const DepthError> errors) {
  std::vector<double> relative;
  for (const DepthError& error : errors) relative.push_back(error.relative);
  metrics.set(prefix + "rel_mean", mean(errors, [](const DepthError& e) { return e.relative; }));
  metrics.set(prefix + "rel_median", median_of(relative));
  std::optional<double> rmse =
      mean(errors, [](const DepthError& e) { return e.difference_m * e.difference_m; });
  if (rmse) rmse = std::sqrt(*rmse);
  metrics.set(prefix + "rmse_m", rmse);
  metrics.set(prefix + "delta_1_25", mean(errors, [](const DepthError& e) {
                const double truth = e.depth_m - e.difference_m;
                return std::max(e.depth_m / truth, truth / e.depth_m) < kDelta ? 1 : 0;
              }));
  metrics.set(prefix + "outlier_5_percent",
              mean(errors, [](const DepthError& e) { return e.relative > kOutlier ? 1 : 0; }));
  metrics.set(prefix + "within_1_sigma", fraction_within(errors, 1));
  metrics.set(prefix + "within_2_sigma", fraction_within(errors, 2));
}

void set_counts(Metrics& metrics, const std::string& prefix, const DepthErrors& errors) {
  metrics.set(prefix + "points", static_cast<double>(errors.points));
  metrics.set(prefix + "completeness", errors.edge_pixels == 0
                                           ? std::optional<double>()
                                           : static_cast<double>(errors.found_edge_pixels) /
                                                 static_cast<double>(errors.edge_pixels));
}

/// All views as if they were one.
DepthErrors pooled(std::span<const DepthErrors> views) {
  DepthErrors all;
  for (const DepthErrors& view : views) {
    all.points += view.points;
    all.best.insert(all.best.end(), view.best.begin(), view.best.end());
    all.strict.insert(all.strict.end(), view.strict.begin(), view.strict.end());
    all.edge_pixels += view.edge_pixels;
    all.found_edge_pixels += view.found_edge_pixels;
  }
  return all;
}

/// Median and worst of a figure over the views; a view that lacks it is the worst.
void set_spread(Metrics& metrics, const std::string& name, std::span<const Metrics> views,
                bool more_is_better) {
  std::vector<double> values;
  for (const Metrics& view : views)
    if (const auto value = view.get(name)) values.push_back(*value);
  const std::string key = "depth.views." + name;
  metrics.set(key + ".median", median_of(values));
  std::optional<double> worst;
  if (!values.empty() && values.size() == views.size())
    worst = more_is_better ? *std::min_element(values.begin(), values.end())
                           : *std::max_element(values.begin(), values.end());
  metrics.set(key + ".worst", worst);
}

}  // namespace

DepthErrors compare_depth(std::span<const DepthPoint> points, const DepthTruth& truth, double t_s) {
  DepthErrors errors;
  errors.t_s = t_s;
  ImageU8 found(truth.depth.width(), truth.depth.height());
  for (const DepthPoint& point : points) {
    if (!is_inside(truth.depth, point.pixel.x(), point.pixel.y())) continue;
    ++errors.points;
    mark(found, point.pixel);
    if (const auto error = best_error(point, truth.depth)) {
      errors.best.push_back(*error);
      errors.scored.push_back(point);
    }
    if (const auto depth = depth_at(truth.depth, point.pixel))
      errors.strict.push_back(error_of(point, *depth));
  }
  if (truth.has_edges) count_edges(found, truth, errors);
  return errors;
}

Metrics view_scores(const DepthErrors& view) {
  Metrics metrics;
  set_errors(metrics, "", view.best);
  set_errors(metrics, "strict.", view.strict);
  set_counts(metrics, "", view);
  return metrics;
}

void set_depth_scores(Metrics& metrics, std::span<const DepthErrors> views) {
  const DepthErrors all = pooled(views);
  set_errors(metrics, "depth.", all.best);
  set_errors(metrics, "depth.strict.", all.strict);
  set_counts(metrics, "depth.", all);
  std::vector<Metrics> scores;
  for (const DepthErrors& view : views) scores.push_back(view_scores(view));
  metrics.set("depth.views.count", static_cast<double>(views.size()));
  for (const char* name : {"rel_mean", "rel_median", "outlier_5_percent"})
    set_spread(metrics, name, scores, false);
  for (const char* name : {"completeness", "points"}) set_spread(metrics, name, scores, true);
}

}  // namespace saccade
