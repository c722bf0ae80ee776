#include "estimator/reconstruction/equation_reconstruction.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "estimator/reconstruction/gradient_images.h"
#include "estimator/reconstruction/level_system.h"
#include "estimator/reconstruction/poisson.h"
#include "estimator/reconstruction/reference_grid.h"
#include "estimator/stage_clock.h"

namespace saccade {
namespace {

/// The view with `scale` pixels in place of one, the first centred on the first.
PinholeCamera finer(const PinholeCamera& camera, int scale) {
  PinholeCamera fine = camera.undistorted();
  fine.width = scale * (camera.width - 1) + 1;
  fine.height = scale * (camera.height - 1) + 1;
  fine.fx *= scale;
  fine.fy *= scale;
  fine.cx *= scale;
  fine.cy *= scale;
  return fine;
}

float value_at(const ImageF& image, const GridPoint& point) {
  float value = 0;
  for (std::size_t k = 0; k < 4; ++k)
    value += point.weight[k] * image.pixels()[static_cast<std::size_t>(point.index[k])];
  return value;
}

/// Indices of the levels by track, in order of time.
struct ByTrack {
  std::vector<std::uint32_t> first;  ///< of every track, and the end
  std::vector<PlaceLevel> levels;

  ByTrack(const std::vector<PlaceLevel>& unordered, std::uint32_t tracks)
      : first(tracks + 1), levels(unordered.size()) {
    for (const PlaceLevel& level : unordered) ++first[level.track + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (const PlaceLevel& level : unordered) levels[next[level.track]++] = level;
  }
  [[nodiscard]] std::span<const PlaceLevel> track(std::size_t i) const {
    return std::span(levels).subspan(first[i], first[i + 1] - first[i]);
  }
};

/// What a level is taken for in one round.
struct Target {
  float level, weight;
};

/// In the first round a silent pixel is where it is likely; later it is pulled to the nearer end of
/// its bounds where the image is beyond them, and hardly where it is within. Events that disagree
/// with the image count less (Cauchy's weights). `seen`: the image's level, less the track's
/// offset.
Target target_of(const PlaceLevel& level, std::optional<float> seen,
                 const EquationOptions& options) {
  float weight = 1 / (level.deviation * level.deviation);
  if (!seen) return {level.level + level.beyond, weight};
  const float error = *seen - level.level;
  if (level.slack > 0) {
    const auto sigma = static_cast<float>(options.bound_sigma);
    return {level.level + std::clamp(error, -level.slack, level.slack), 1 / (sigma * sigma)};
  }
  const float share = error / (static_cast<float>(options.outlier) * level.deviation);
  return {level.level, weight / (1 + share * share)};
}

/// The offset of a track that agrees best with the image.
float offset_of(std::span<const PlaceLevel> levels, std::span<const GridPoint> places,
                const ImageF& image) {
  float offset = 0, sum = 0;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const float weight = 1 / (levels[k].deviation * levels[k].deviation);
    offset += weight * (value_at(image, places[k]) - levels[k].level - levels[k].beyond);
    sum += weight;
  }
  return offset / sum;
}

/// All levels; after the first round `image` is what it found.
void add_levels(LevelSystem& system, const ReferenceGrid& grid, const ByTrack& tracks,
                const ImageF& image, const EquationOptions& options) {
  std::vector<GridPoint> places;
  for (std::size_t t = 0; t + 1 < tracks.first.size(); ++t) {
    const auto levels = tracks.track(t);
    if (levels.size() < 2) continue;
    places.clear();
    for (const PlaceLevel& level : levels) places.push_back(grid.at(level.x, level.y));
    const float offset = image.empty() ? 0 : offset_of(levels, places, image);
    system.begin_track();
    for (std::size_t k = 0; k < levels.size(); ++k) {
      std::optional<float> seen;
      if (!image.empty()) seen = value_at(image, places[k]) - offset;
      const Target target = target_of(levels[k], seen, options);
      system.add(places[k], target.level, target.weight);
    }
    system.end_track();
  }
}

/// The squared difference of neighbours; against an image their absolute difference (total
/// variation), reweighted.
void add_smoothness(LevelSystem& system, const ReferenceGrid& grid, const EquationOptions& options,
                    const ImageF& image) {
  const auto within = static_cast<float>(1 / (options.smoothness * options.smoothness));
  const auto across = static_cast<float>(1 / (options.across * options.across));
  const auto knee = static_cast<float>(options.knee);
  const auto add = [&](int i, int j) {
    float weight = grid.is_joined(i, j) ? within : across;
    if (!image.empty()) {
      const float difference = std::abs(image.pixels()[static_cast<std::size_t>(i)] -
                                        image.pixels()[static_cast<std::size_t>(j)]);
      weight *= knee / std::max(difference, knee);
    }
    system.add_smooth(i, j, weight);
  };
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) {
      const int i = y * grid.width() + x;
      if (x + 1 < grid.width()) add(i, i + 1);
      if (y + 1 < grid.height()) add(i, i + grid.width());
    }
}

/// The gradient of `image` by central differences; its covariance from the directions in which
/// tracks pass a pixel, (I / P0 + sum h h^T / R)^-1 as of the filter.
std::vector<GradientState> gradient_states(const PinholeCamera& camera, const ImageF& image,
                                           const ByTrack& tracks, double prior_sigma) {
  std::vector<GradientState> states(image.size());
  const auto prior = static_cast<float>(1 / (prior_sigma * prior_sigma));
  for (GradientState& s : states) s.pxx = s.pyy = prior;
  for (std::size_t k = 1; k < tracks.levels.size(); ++k) {
    const PlaceLevel& from = tracks.levels[k - 1];
    const PlaceLevel& to = tracks.levels[k];
    if (from.track != to.track) continue;
    const float hx = to.x - from.x;
    const float hy = to.y - from.y;
    const float weight = 1 / (to.deviation * to.deviation * std::max(0.02F, std::hypot(hx, hy)));
    const auto x = static_cast<int>(std::lround(to.x));
    const auto y = static_cast<int>(std::lround(to.y));
    GradientState& s = states[static_cast<std::size_t>(y * camera.width + x)];
    s.pxx += weight * hx * hx;
    s.pxy += weight * hx * hy;
    s.pyy += weight * hy * hy;
  }
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      GradientState& s = states[static_cast<std::size_t>(y * camera.width + x)];
      const float determinant = s.pxx * s.pyy - s.pxy * s.pxy;
      s = {0, 0, s.pyy / determinant, -s.pxy / determinant, s.pxx / determinant};
      const int left = std::max(x - 1, 0), right = std::min(x + 1, image.width() - 1);
      const int top = std::max(y - 1, 0), bottom = std::min(y + 1, image.height() - 1);
      s.gx = (image(right, y) - image(left, y)) / static_cast<float>(right - left);
      s.gy = (image(x, bottom) - image(x, top)) / static_cast<float>(bottom - top);
    }
  return states;
}

/// Every `scale`-th pixel.
ImageF coarser(const ImageF& image, int scale) {
  ImageF coarse((image.width() - 1) / scale + 1, (image.height() - 1) / scale + 1);
  for (int y = 0; y < coarse.height(); ++y)
    for (int x = 0; x < coarse.width(); ++x) coarse(x, y) = image(x * scale, y * scale);
  return coarse;
}

}  // namespace

Reconstruction EquationReconstruction::reconstruct(const ReconstructionWindow& window) const {
  double levels_s = 0, equations_s = 0, solve_s = 0;
  const Rigid3 reference_from_world = window.world_from_reference().inverse();
  ImageF reference(camera_.width, camera_.height);
  std::vector<PlaceLevel> unordered;
  std::uint32_t count = 0;
  {
    const StageClock clock(levels_s);
    window.scene.draw(reference_from_world, camera_.undistorted(), reference);
    LevelFinder finder(camera_, window.scene, reference_from_world.inverse(), reference,
                       window.contrast_on, window.contrast_off, options_.levels);
    finder.find(window.events, *window.trajectory, unordered);
    count = finder.tracks();
  }
  const ByTrack tracks(unordered, count);
  const PinholeCamera fine = finer(camera_, options_.scale);
  ImageF fine_reference(fine.width, fine.height);
  window.scene.draw(reference_from_world, fine, fine_reference);
  const ReferenceGrid grid(fine_reference, options_.scale, options_.levels.same_surface);
  ImageF image;
  for (int round = 0; round < options_.rounds; ++round) {
    LevelSystem system(grid.width(), grid.height());
    {
      const StageClock clock(equations_s);
      add_levels(system, grid, tracks, image, options_);
      add_smoothness(system, grid, options_, image);
    }
    const StageClock clock(solve_s);
    image = system.solve(options_.iterations, options_.tolerance, image).image;
  }
  Reconstruction result;
  result.log_image = coarser(image, options_.scale);
  subtract_mean(result.log_image);
  set_gradient(result, camera_,
               gradient_states(camera_, result.log_image, tracks, options_.prior_sigma),
               options_.observed_sigma);
  result.levels = tracks.levels.size();
  result.stages_s = {{"levels", levels_s}, {"equations", equations_s}, {"solve", solve_s}};
  return result;
}

}  // namespace saccade
