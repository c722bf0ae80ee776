#include "estimator/reconstruction/equation_reconstruction.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "core/check.h"
#include "estimator/reconstruction/gradient_images.h"
#include "estimator/reconstruction/level_system.h"
#include "estimator/reconstruction/poisson.h"
#include "estimator/reconstruction/reference_grid.h"
#include "estimator/stage_clock.h"

namespace saccade {
namespace {

constexpr std::size_t kBatch = 65536;  ///< events whose levels are found at a time

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

struct WeightedSort : LevelSort {
  float weight;  ///< 1 / deviation^2
};

/// All levels by track and, within one, in order of time. Tracks that begin near each other follow
/// each other, so that what they touch is at hand.
class LevelsByTrack {
 public:
  LevelsByTrack(const PinholeCamera& camera, std::span<const LevelSort> sorts)
      : tiles_per_row_(camera.width / kTile + 1),
        tiles_(static_cast<std::size_t>(tiles_per_row_ * (camera.height / kTile + 1))) {
    for (const LevelSort& sort : sorts)
      sorts_.push_back({sort, 1 / (sort.deviation * sort.deviation)});
  }

  /// Tracks are new in the order of their numbers.
  void add(std::span<const PlaceLevel> levels) {
    for (const PlaceLevel& l : levels) {
      if (l.track() == homes_.size()) {
        const auto tile = static_cast<std::uint32_t>(
            static_cast<int>(l.y) / kTile * tiles_per_row_ + static_cast<int>(l.x) / kTile);
        homes_.push_back({tile, tiles_[tile].tracks++});
      }
      const Home home = homes_[l.track()];
      tiles_[home.tile].levels.push_back(
          {l.x, l.y, l.level, PlaceLevel::tag(home.track, l.sort())});
    }
  }

  /// After the last add(). Joins successive levels of one sort whose places lie within `thin_px` of
  /// the first of them: what they say of the image is nearly the same, and their mean says it.
  void order(float thin_px) {
    std::vector<PlaceLevel> ordered;
    std::vector<std::uint32_t> next;
    for (Tile& tile : tiles_) {
      tile.first.assign(tile.tracks + 1, 0);
      for (const PlaceLevel& level : tile.levels) ++tile.first[level.track() + 1];
      std::partial_sum(tile.first.begin(), tile.first.end(), tile.first.begin());
      next.assign(tile.first.begin(), tile.first.end() - 1);
      ordered.resize(tile.levels.size());
      for (const PlaceLevel& level : tile.levels) ordered[next[level.track()]++] = level;
      thin(ordered, thin_px, tile);
      size_ += tile.levels.size();
    }
    homes_ = {};
  }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Calls body(levels) for every track.
  template <class Body>
  void for_each(const Body& body) const {
    for (const Tile& tile : tiles_)
      for (std::size_t t = 0; t < tile.tracks; ++t)
        body(std::span(tile.levels).subspan(tile.first[t], tile.first[t + 1] - tile.first[t]));
  }
  [[nodiscard]] const WeightedSort& sort(const PlaceLevel& level) const {
    return sorts_[level.sort()];
  }

 private:
  static constexpr int kTile = 16;  ///< [px]

  struct Tile {
    std::vector<PlaceLevel> levels;    ///< with the tile's own numbers of tracks
    std::vector<std::uint32_t> first;  ///< of every track, and the end
    std::uint32_t tracks = 0;
  };
  /// Where a track is.
  struct Home {
    std::uint32_t tile, track;
  };

  static void thin(std::span<const PlaceLevel> all, float px, Tile& tile) {
    std::size_t end = 0;
    for (std::size_t t = 0; t < tile.tracks; ++t) {
      const std::size_t begin = tile.first[t], last = tile.first[t + 1];
      tile.first[t] = static_cast<std::uint32_t>(end);
      for (std::size_t k = begin; k < last;) {
        const PlaceLevel head = all[k];
        float x = 0, y = 0, level = 0;
        std::size_t n = 1;
        for (; k + n < last; ++n) {
          const PlaceLevel& next = all[k + n];
          const float dx = next.x - head.x, dy = next.y - head.y;
          if (next.sort() != head.sort() || !(dx * dx + dy * dy <= px * px) || px == 0) break;
          x += dx;
          y += dy;
          level += next.level - head.level;
        }
        const float share = 1 / static_cast<float>(n);
        tile.levels[end++] = {head.x + x * share, head.y + y * share, head.level + level * share,
                              head.track_and_sort};
        k += n;
      }
    }
    tile.first.back() = static_cast<std::uint32_t>(end);
    tile.levels.resize(end);
  }

  std::vector<WeightedSort> sorts_;
  int tiles_per_row_;
  std::vector<Tile> tiles_;
  std::vector<Home> homes_;  ///< of every track
  std::size_t size_ = 0;
};

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
      const auto x = static_cast<int>(to.x + 0.5F);
      const auto y = static_cast<int>(to.y + 0.5F);
      GradientState& s = states[static_cast<std::size_t>(y * camera.width + x)];
      s.pxx += weight * hx * hx;
      s.pxy += weight * hx * hy;
      s.pyy += weight * hy * hy;
    }
  });
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
  double levels_s = 0, order_s = 0, equations_s = 0, solve_s = 0;
  const Rigid3 reference_from_world = window.world_from_reference().inverse();
  ImageF reference(camera_.width, camera_.height);
  window.scene.draw(reference_from_world, camera_.undistorted(), reference);
  LevelFinder finder(camera_, window.scene, reference_from_world.inverse(), reference,
                     window.contrast_on, window.contrast_off, options_.levels);
  finder.expect(window.events);
  LevelsByTrack tracks(camera_, finder.sorts());
  {
    const StageClock clock(levels_s);
    std::vector<PlaceLevel> part;
    for (std::size_t begin = 0; begin < window.events.size(); begin += kBatch) {
      part.clear();
      finder.find(window.events.subspan(begin, std::min(kBatch, window.events.size() - begin)),
                  *window.trajectory, part);
      tracks.add(part);
    }
  }
  {
    const StageClock clock(order_s);
    tracks.order(static_cast<float>(options_.thin_px));
  }
  const PinholeCamera fine = finer(camera_, options_.scale);
  ImageF fine_reference(fine.width, fine.height);
  window.scene.draw(reference_from_world, fine, fine_reference);
  const ReferenceGrid grid(fine_reference, options_.scale, options_.levels.places.same_surface);
  ImageF image;
  LevelSystem system(grid.width(), grid.height());
  for (int round = 0; round < options_.rounds; ++round) {
    {
      const StageClock clock(equations_s);
      system.clear();
      system.reserve(tracks.size());
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
  result.levels = tracks.size();
  result.stages_s = {
      {"levels", levels_s}, {"order", order_s}, {"equations", equations_s}, {"solve", solve_s}};
  return result;
}

}  // namespace saccade
