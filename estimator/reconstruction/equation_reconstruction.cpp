#include "estimator/reconstruction/equation_reconstruction.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
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

constexpr std::size_t kBatch = 16384;  ///< events whose levels are found at a time

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

/// What distinguishes few sorts of levels: see PlaceLevel.
struct LevelSort {
  float deviation, slack, beyond;
  bool operator==(const LevelSort&) const = default;
};

/// A level in as little memory as will do, of which there are several per event.
struct KeptLevel {
  float x, y, level;
  std::uint32_t track_and_sort;  ///< the sort in the lowest bits

  [[nodiscard]] std::uint32_t track() const { return track_and_sort >> kSortBits; }
  [[nodiscard]] std::uint32_t sort() const { return track_and_sort & ((1U << kSortBits) - 1); }
  static constexpr std::uint32_t kSortBits = 3;
};

/// All levels by track and, within one, in order of time. Tracks that begin near each other follow
/// each other, so that what they touch is at hand.
class LevelsByTrack {
 public:
  void add(std::span<const PlaceLevel> levels) {
    std::vector<KeptLevel>& part = parts_.emplace_back();
    part.reserve(levels.size());
    for (const PlaceLevel& l : levels)
      part.push_back({l.x, l.y, l.level,
                      l.track << KeptLevel::kSortBits | sort_of({l.deviation, l.slack, l.beyond})});
  }
  /// After the last add().
  void order(std::uint32_t tracks) {
    const std::vector<std::uint32_t> rank = ranks(tracks);
    first_.assign(tracks + 1, 0);
    for (const auto& part : parts_)
      for (const KeptLevel& level : part) ++first_[rank[level.track()] + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    levels_.resize(first_.back());
    for (const auto& part : parts_)
      for (const KeptLevel& level : part) levels_[next[rank[level.track()]]++] = level;
    parts_.clear();
  }
  /// Joins successive levels of one sort whose places lie within `px` of the first of them: what
  /// they say of the image is nearly the same, and their mean says it.
  void thin(float px) {
    std::size_t end = 0;
    for (std::size_t t = 0; t + 1 < first_.size(); ++t) {
      const std::size_t begin = first_[t], last = first_[t + 1];
      first_[t] = static_cast<std::uint32_t>(end);
      for (std::size_t k = begin; k < last;) {
        const KeptLevel head = levels_[k];
        float x = 0, y = 0, level = 0;
        std::size_t n = 0;
        for (; k + n < last; ++n) {
          const KeptLevel& next = levels_[k + n];
          const float dx = next.x - head.x, dy = next.y - head.y;
          if (next.sort() != head.sort() || dx * dx + dy * dy > px * px) break;
          x += dx;
          y += dy;
          level += next.level - head.level;
        }
        const float share = 1 / static_cast<float>(n);
        levels_[end++] = {head.x + x * share, head.y + y * share, head.level + level * share,
                          head.track_and_sort};
        k += n;
      }
    }
    first_.back() = static_cast<std::uint32_t>(end);
    levels_.resize(end);
  }
  [[nodiscard]] std::size_t size() const { return levels_.size(); }
  [[nodiscard]] std::size_t tracks() const { return first_.size() - 1; }
  [[nodiscard]] std::span<const KeptLevel> track(std::size_t i) const {
    return std::span(levels_).subspan(first_[i], first_[i + 1] - first_[i]);
  }
  [[nodiscard]] const LevelSort& sort(const KeptLevel& level) const { return sorts_[level.sort()]; }

 private:
  /// The place of every track in the order of where they begin.
  [[nodiscard]] std::vector<std::uint32_t> ranks(std::uint32_t tracks) const {
    constexpr int kTile = 16, kTilesPerRow = 4096;
    std::vector<std::uint32_t> tile(tracks, std::numeric_limits<std::uint32_t>::max());
    for (const auto& part : parts_)
      for (const KeptLevel& level : part)
        if (std::uint32_t& t = tile[level.track()]; t == std::numeric_limits<std::uint32_t>::max())
          t = static_cast<std::uint32_t>(static_cast<int>(level.y) / kTile * kTilesPerRow +
                                         static_cast<int>(level.x) / kTile);
    std::vector<std::uint32_t> order(tracks);
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return tile[a] < tile[b]; });
    std::vector<std::uint32_t> rank(tracks);
    for (std::uint32_t i = 0; i < tracks; ++i) rank[order[i]] = i;
    return rank;
  }

  std::uint32_t sort_of(const LevelSort& sort) {
    const auto found = std::find(sorts_.begin(), sorts_.end(), sort);
    const auto index = static_cast<std::uint32_t>(found - sorts_.begin());
    if (found == sorts_.end()) sorts_.push_back(sort);
    SACCADE_CHECK(index < 1U << KeptLevel::kSortBits);
    return index;
  }

  std::vector<std::vector<KeptLevel>> parts_;
  std::vector<KeptLevel> levels_;
  std::vector<std::uint32_t> first_;  ///< of every track, and the end
  std::vector<LevelSort> sorts_;
};

/// What a level is taken for in one round.
struct Target {
  float level, weight;
};

/// In the first round a silent pixel is where it is likely; later it is pulled to the nearer end of
/// its bounds where the image is beyond them, and hardly where it is within. Events that disagree
/// with the image count less (Cauchy's weights). `seen`: the image's level, less the track's
/// offset.
Target target_of(float level, const LevelSort& sort, std::optional<float> seen,
                 const EquationOptions& options) {
  const float weight = 1 / (sort.deviation * sort.deviation);
  if (!seen) return {level + sort.beyond, weight};
  const float error = *seen - level;
  if (sort.slack > 0) {
    const auto sigma = static_cast<float>(options.bound_sigma);
    return {level + std::clamp(error, -sort.slack, sort.slack), 1 / (sigma * sigma)};
  }
  const float share = error / (static_cast<float>(options.outlier) * sort.deviation);
  return {level, weight / (1 + share * share)};
}

/// The offset of a track that agrees best with what the image shows at its places.
float offset_of(const LevelsByTrack& all, std::span<const KeptLevel> levels,
                std::span<const float> seen) {
  float offset = 0, sum = 0;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const LevelSort& sort = all.sort(levels[k]);
    const float weight = 1 / (sort.deviation * sort.deviation);
    offset += weight * (seen[k] - levels[k].level - sort.beyond);
    sum += weight;
  }
  return offset / sum;
}

/// All levels; after the first round `image` is what it found.
void add_levels(LevelSystem& system, const ReferenceGrid& grid, const LevelsByTrack& all,
                const ImageF& image, const EquationOptions& options) {
  std::vector<GridPoint> places;
  std::vector<float> seen;
  for (std::size_t t = 0; t < all.tracks(); ++t) {
    const auto levels = all.track(t);
    if (levels.size() < 2) continue;
    places.clear();
    seen.clear();
    for (const KeptLevel& level : levels) places.push_back(grid.at(level.x, level.y));
    if (!image.empty())
      for (const GridPoint& place : places) seen.push_back(value_at(image, place));
    const float offset = image.empty() ? 0 : offset_of(all, levels, seen);
    system.begin_track();
    for (std::size_t k = 0; k < levels.size(); ++k) {
      std::optional<float> here;
      if (!image.empty()) here = seen[k] - offset;
      const Target target = target_of(levels[k].level, all.sort(levels[k]), here, options);
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
                                           const LevelsByTrack& all, double prior_sigma) {
  std::vector<GradientState> states(image.size());
  const auto prior = static_cast<float>(1 / (prior_sigma * prior_sigma));
  for (GradientState& s : states) s.pxx = s.pyy = prior;
  for (std::size_t t = 0; t < all.tracks(); ++t) {
    const auto levels = all.track(t);
    for (std::size_t k = 1; k < levels.size(); ++k) {
      const KeptLevel& to = levels[k];
      const float hx = to.x - levels[k - 1].x;
      const float hy = to.y - levels[k - 1].y;
      const float deviation = all.sort(to).deviation;
      const float weight =
          1 / (deviation * deviation * std::max(0.02F, std::sqrt(hx * hx + hy * hy)));
      const auto x = static_cast<int>(to.x + 0.5F);
      const auto y = static_cast<int>(to.y + 0.5F);
      GradientState& s = states[static_cast<std::size_t>(y * camera.width + x)];
      s.pxx += weight * hx * hx;
      s.pxy += weight * hx * hy;
      s.pyy += weight * hy * hy;
    }
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
  LevelsByTrack tracks;
  {
    const StageClock clock(levels_s);
    window.scene.draw(reference_from_world, camera_.undistorted(), reference);
    LevelFinder finder(camera_, window.scene, reference_from_world.inverse(), reference,
                       window.contrast_on, window.contrast_off, options_.levels);
    std::vector<PlaceLevel> part;
    for (std::size_t begin = 0; begin < window.events.size(); begin += kBatch) {
      part.clear();
      finder.find(window.events.subspan(begin, std::min(kBatch, window.events.size() - begin)),
                  *window.trajectory, part);
      tracks.add(part);
    }
    tracks.order(finder.tracks());
    if (options_.thin_px > 0) tracks.thin(static_cast<float>(options_.thin_px));
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
  result.stages_s = {{"levels", levels_s}, {"equations", equations_s}, {"solve", solve_s}};
  return result;
}

}  // namespace saccade
