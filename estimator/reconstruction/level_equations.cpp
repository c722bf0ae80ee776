#include "estimator/reconstruction/level_equations.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/stopwatch.h"
#include "estimator/reconstruction/gradient_images.h"
#include "estimator/reconstruction/level_system.h"
#include "estimator/reconstruction/levels_by_track.h"
#include "estimator/reconstruction/poisson.h"

namespace saccade {
namespace {

float value_at(const ImageF& image, const GridPoint& point) {
  float value = 0;
  for (std::size_t k = 0; k < 4; ++k)
    value += point.weight[k] * image.pixels()[static_cast<std::size_t>(point.index[k])];
  return value;
}

/// What a level is taken for in one round.
struct Target {
  float level, weight;
};

/// In the first round a silent pixel is where it is likely; later it is pulled to the nearer end of
/// its bounds where the image is beyond them, and hardly where it is within. Events that disagree
/// with the image count less (Cauchy's weights). `seen`: the image's level, less the track's
/// offset.
Target target_of(float level, const WeightedSort& sort, float seen,
                 const EquationOptions& options) {
  const float error = seen - level;
  if (sort.slack > 0) {
    const auto sigma = static_cast<float>(options.bound_sigma);
    return {level + std::clamp(error, -sort.slack, sort.slack), 1 / (sigma * sigma)};
  }
  const float share = error / static_cast<float>(options.outlier);
  return {level, sort.weight / (1 + share * share * sort.weight)};
}

/// The offset of a track that agrees best with what the image shows at its places.
float offset_of(const LevelsByTrack& all, std::span<const PlaceLevel> levels,
                std::span<const float> seen) {
  float offset = 0, sum = 0;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const WeightedSort& sort = all.sort(levels[k]);
    offset += sort.weight * (seen[k] - levels[k].level - sort.beyond);
    sum += sort.weight;
  }
  return offset / sum;
}

/// All levels; after the first round `image` is what it found.
void add_levels(LevelSystem& system, const ReferenceGrid& grid, const LevelsByTrack& all,
                const ImageF& image, const EquationOptions& options) {
  std::vector<GridLevel> track;
  std::vector<float> seen;
  all.for_each([&](std::span<const PlaceLevel> levels) {
    if (levels.size() < 2) return;
    track.resize(levels.size());
    seen.resize(levels.size());
    for (std::size_t k = 0; k < levels.size(); ++k)
      track[k].place = grid.at(levels[k].x, levels[k].y);
    if (image.empty()) {
      for (std::size_t k = 0; k < levels.size(); ++k) {
        const WeightedSort& sort = all.sort(levels[k]);
        track[k].level = levels[k].level + sort.beyond;
        track[k].weight = sort.weight;
      }
    } else {
      for (std::size_t k = 0; k < levels.size(); ++k) seen[k] = value_at(image, track[k].place);
      const float offset = offset_of(all, levels, seen);
      for (std::size_t k = 0; k < levels.size(); ++k) {
        const Target target =
            target_of(levels[k].level, all.sort(levels[k]), seen[k] - offset, options);
        track[k].level = target.level;
        track[k].weight = target.weight;
      }
    }
    system.add_track(track);
  });
}

/// The squared difference of neighbours; against an image their absolute difference (total
/// variation), reweighted.
void add_smoothness(LevelSystem& system, const ReferenceGrid& grid, const EquationOptions& options,
                    const ImageF& image) {
  const auto within = static_cast<float>(1 / (options.smoothness * options.smoothness));
  const auto across = static_cast<float>(1 / (options.across * options.across));
  const auto knee = static_cast<float>(options.knee);
  const auto add = [&](int i, int j, float shape) {
    if (j < 0) return;
    float weight = shape * (grid.is_joined(i, j) ? within : across);
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
      add(i, grid.right_of(x, y), 1 / grid.row_width(y));
      add(i, grid.below(x, y), grid.row_width(y));
    }
}

/// The gradient of `image` by central differences; its covariance from the directions in which
/// tracks pass a pixel, (I / P0 + sum h h^T / R)^-1 as of the filter.
std::vector<GradientState> gradient_states(const ReferenceGrid& view, const ImageF& image,
                                           const LevelsByTrack& all, double prior_sigma) {
  std::vector<GradientState> states(image.size());
  const auto prior = static_cast<float>(1 / (prior_sigma * prior_sigma));
  for (GradientState& s : states) s.pxx = s.pyy = prior;
  all.for_each([&](std::span<const PlaceLevel> levels) {
    for (std::size_t k = 1; k < levels.size(); ++k) {
      const PlaceLevel& to = levels[k];
      const float hx = to.x - levels[k - 1].x;
      const float hy = to.y - levels[k - 1].y;
      const float weight = all.sort(to).weight / std::max(0.02F, std::sqrt(hx * hx + hy * hy));
      GradientState& s = states[view.nearest(to.x, to.y)];
      s.pxx += weight * hx * hx;
      s.pxy += weight * hx * hy;
      s.pyy += weight * hy * hy;
    }
  });
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      GradientState& s = states[static_cast<std::size_t>(y * image.width() + x)];
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

Reconstruction solve_equations(LevelFinder& finder, std::span<const Event> events,
                               const Trajectory& world_from_camera, const ReferenceGrid& view,
                               const ReferenceGrid& grid, const EquationOptions& options,
                               const ShareDone& done) {
  // Finding the levels takes about as long as what follows.
  constexpr double kLevelsShare = 0.5;
  double order_s = 0, equations_s = 0, solve_s = 0;
  LevelsByTrack tracks(view, finder.sorts());
  const double levels_s = finder.find_all(events, world_from_camera,
                                          [&](std::span<const PlaceLevel> part, double share) {
                                            tracks.add(part);
                                            if (done) done(kLevelsShare * share);
                                          });
  {
    const ScopedTimer clock(order_s);
    tracks.order(static_cast<float>(options.thin_px));
  }
  ImageF image;
  LevelSystem system(grid.width(), grid.height(), grid.wraps());
  for (int round = 0; round < options.rounds; ++round) {
    {
      const ScopedTimer clock(equations_s);
      system.clear();
      system.reserve(tracks.size());
      add_levels(system, grid, tracks, image, options);
      add_smoothness(system, grid, options, image);
    }
    {
      const ScopedTimer clock(solve_s);
      image = system.solve(options.iterations, options.tolerance, image).image;
    }
    if (done) done(kLevelsShare + (1 - kLevelsShare) * (round + 1) / options.rounds);
  }
  Reconstruction result;
  result.log_image = coarser(image, grid.scale());
  subtract_mean(result.log_image);
  set_gradient(result, view, gradient_states(view, result.log_image, tracks, options.prior_sigma),
               options.observed_sigma);
  result.levels = tracks.size();
  result.stages_s = {
      {"levels", levels_s}, {"order", order_s}, {"equations", equations_s}, {"solve", solve_s}};
  return result;
}

}  // namespace saccade
