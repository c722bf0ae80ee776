#include "estimator/reconstruction/equations/equation_reconstruction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/process/parallel.h"
#include "core/stopwatch.h"
#include "estimator/reconstruction/equations/event_runs.h"
#include "estimator/reconstruction/equations/intensity_system.h"
#include "estimator/reconstruction/gradient/gradient_images.h"
#include "estimator/reconstruction/gradient/poisson.h"

namespace saccade {
namespace {

/// Bands of the sensor's rows, whose event runs threads work on by themselves. Their number decides in which order
/// sums are taken, so it does not depend on the number of threads.
constexpr std::size_t kMostBands = 8;
/// Each band has sums of its own over the image, a hundred bytes a pixel: in all 0.3 GB.
constexpr std::size_t kMostPixelsOfBands = 3'000'000;

std::size_t bands_for(const ReferenceGrid& grid) {
  const auto pixels =
      static_cast<std::size_t>(grid.width()) * static_cast<std::size_t>(grid.height());
  return std::clamp<std::size_t>(kMostPixelsOfBands / pixels, 1, kMostBands);
}

/// Rounds of reweighting: the first with quadratic costs, the second with robust ones.
constexpr int kRounds = 2;
/// Conjugate gradient iterations per round, at most.
constexpr int kIterations = 60;
/// Scale of Cauchy's weights, in standard deviations.
constexpr float kOutlierSigmas = 3;
/// Difference of neighbours from which on the prior is their absolute difference (total variation).
constexpr float kHuberThreshold = 0.02F;
/// Standard deviation of a view's log intensity about its mean, twice what scenes usually have: it shall hold what is hardly
/// known alone, such as how one part of a view compares with another where few events lie between. The slopes of event
/// runs err alike where thresholds are unequal or drift, so that many of them know less together than they say.
constexpr float kLevelSigma = 2;
/// As EquationOptions::smoothness_sigma, across an occluding contour: next to no prior.
constexpr double kContourSigma = 20;

float value_at(const ImageF& image, const GridPoint& point) {
  float value = 0;
  for (std::size_t k = 0; k < 4; ++k)
    value += point.weight[k] * image.pixels()[static_cast<std::size_t>(point.index[k])];
  return value;
}

/// The offset of a run that agrees best with the image values at its reprojections.
float offset_of(const EventRuns& runs, std::span<const IntensityObservation> run,
                std::span<const float> values) {
  float offset = 0, sum = 0;
  for (std::size_t k = 0; k < run.size(); ++k) {
    const ObservationKind& kind = runs.kind(run[k]);
    offset += kind.weight * (values[k] - run[k].log_intensity - kind.expected);
    sum += kind.weight;
  }
  return offset / sum;
}

/// Log intensity and weight of an observation against the image of the round before, whose value less
/// the run's offset is `value`. A no-event constraint pulls to the nearer bound where the image is
/// beyond its bounds, and hardly where it is within; an event inconsistent with the image has less
/// weight (Cauchy).
void reweight(GridObservation& target, float log_intensity, const ObservationKind& kind,
              float value, float bound_sigma) {
  const float error = value - log_intensity;
  if (kind.slack > 0) {
    target.log_intensity = log_intensity + std::clamp(error, -kind.slack, kind.slack);
    target.weight = 1 / (bound_sigma * bound_sigma);
    return;
  }
  const float ratio = error / kOutlierSigmas;
  target.log_intensity = log_intensity;
  target.weight = kind.weight / (1 + ratio * ratio * kind.weight);
}

/// All observations of a part; `image` is that of the round before, empty in the first.
void add_observations(IntensitySystem& system, std::size_t part, const ReferenceGrid& grid,
                      const EventRuns& runs, const ImageF& image, float bound_sigma) {
  system.reserve(part, runs.size());
  std::vector<GridObservation> targets;
  std::vector<float> values;
  runs.for_each([&](std::span<const IntensityObservation> run) {
    if (run.size() < 2) return;
    targets.resize(run.size());
    values.resize(run.size());
    for (std::size_t k = 0; k < run.size(); ++k) {
      targets[k].x = run[k].x;
      targets[k].y = run[k].y;
      targets[k].point = grid.at(run[k].x, run[k].y);
    }
    if (image.empty()) {
      for (std::size_t k = 0; k < run.size(); ++k) {
        const ObservationKind& kind = runs.kind(run[k]);
        targets[k].log_intensity = run[k].log_intensity + kind.expected;
        targets[k].weight = kind.weight;
      }
    } else {
      for (std::size_t k = 0; k < run.size(); ++k) values[k] = value_at(image, targets[k].point);
      const float offset = offset_of(runs, run, values);
      for (std::size_t k = 0; k < run.size(); ++k)
        reweight(targets[k], run[k].log_intensity, runs.kind(run[k]), values[k] - offset,
                 bound_sigma);
    }
    system.add_run(part, targets);
  });
}

/// The squared difference of neighbours; against an image their absolute difference (total
/// variation) by reweighting.
void add_smoothness(IntensitySystem& system, const ReferenceGrid& grid,
                    const EquationOptions& options, const ImageF& image) {
  const double sigma = options.smoothness_sigma * (image.empty() ? options.first_smoothness : 1);
  const auto within = static_cast<float>(1 / (sigma * sigma));
  const auto across = static_cast<float>(1 / (kContourSigma * kContourSigma));
  const auto add = [&](int i, int j, float shape) {
    if (j < 0) return;
    float weight = shape * (grid.is_joined(i, j) ? within : across);
    if (!image.empty()) {
      const float difference = std::abs(image.pixels()[static_cast<std::size_t>(i)] -
                                        image.pixels()[static_cast<std::size_t>(j)]);
      weight *= kHuberThreshold / std::max(difference, kHuberThreshold);
    }
    system.add_smoothness_term(i, j, weight);
  };
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) {
      const int i = y * grid.width() + x;
      add(i, grid.right_of(x, y), 1 / grid.row_width(y));
      add(i, grid.below(x, y), grid.row_width(y));
    }
}

/// Adds the information h h^T / R on the gradient by the displacements h of the runs over a pixel, as in
/// the filter.
void add_information(const ReferenceGrid& grid, const EventRuns& runs,
                     std::vector<GradientState>& states) {
  runs.for_each([&](std::span<const IntensityObservation> run) {
    for (std::size_t k = 1; k < run.size(); ++k) {
      const IntensityObservation& to = run[k];
      const float hx = to.x - run[k - 1].x;
      const float hy = to.y - run[k - 1].y;
      const float weight = runs.kind(to).weight / std::max(0.02F, std::sqrt(hx * hx + hy * hy));
      GradientState& s = states[grid.nearest(to.x, to.y)];
      s.pxx += weight * hx * hx;
      s.pxy += weight * hx * hy;
      s.pyy += weight * hy * hy;
    }
  });
}

/// The gradient of `image` by central differences; its covariance (I / P0 + sum h h^T / R)^-1.
std::vector<GradientState> gradient_states(const ReferenceGrid& grid, const ImageF& image,
                                           std::span<const EventRuns> bands) {
  std::vector<std::vector<GradientState>> parts(bands.size(),
                                                std::vector<GradientState>(image.size()));
  parallel_for(bands.size(),
               [&](std::size_t band) { add_information(grid, bands[band], parts[band]); });
  std::vector<GradientState> states(image.size());
  const auto prior = static_cast<float>(1 / (kGradientPriorSigma * kGradientPriorSigma));
  for (GradientState& s : states) s.pxx = s.pyy = prior;
  for (const std::vector<GradientState>& part : parts)
    for (std::size_t i = 0; i < states.size(); ++i) {
      states[i].pxx += part[i].pxx;
      states[i].pxy += part[i].pxy;
      states[i].pyy += part[i].pyy;
    }
  std::size_t i = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      GradientState& s = states[i++];
      const float determinant = s.pxx * s.pyy - s.pxy * s.pxy;
      s = {0, 0, s.pyy / determinant, -s.pxy / determinant, s.pxx / determinant};
      const int left = std::max(x - 1, 0), right = std::min(x + 1, image.width() - 1);
      const int top = std::max(y - 1, 0), bottom = std::min(y + 1, image.height() - 1);
      s.gx = (image(right, y) - image(left, y)) / static_cast<float>(right - left);
      s.gy = (image(x, bottom) - image(x, top)) / static_cast<float>(bottom - top);
    }
  return states;
}

void make_fast(EquationOptions& options) {
  options.observations.no_event_spacing_px = 1.6;
  options.observations.dense_events_per_px = 10;
  options.observations.reprojection.redraw_parallax_px = 2;
  options.merge_radius_px = 1.1;
  options.tolerance = 0.01;
}

}  // namespace

void describe(config::Fields& fields, EquationOptions& options) {
  using Preset = EquationOptions::Preset;
  fields.choice("preset", options.preset, {{"best", Preset::kBest}, {"fast", Preset::kFast}},
                "Setting that the other keys and observations start from: fast has fewer no-event "
                "constraints, renders surfaces less often, and merges and solves more coarsely.");
  if (fields.has("preset") && options.preset == Preset::kFast) make_fast(options);
  fields
      .value("smoothness_sigma", options.smoothness_sigma,
             "Standard deviation of the difference of neighbouring pixels where nothing else is "
             "known, in log units; smaller values give smoother images.")
      .range(1e-4, 1e4);
}

Reconstruction EquationReconstruction::solve(ObservationSource& source,
                                             std::span<const Event> events,
                                             const Trajectory& world_from_camera,
                                             const ReferenceGrid& grid,
                                             const ProgressCallback& progress) const {
  // The observations take about as long as the rest.
  constexpr double kObservationsFraction = 0.5;
  double sort_s = 0, assembly_s = 0, solve_s = 0;
  std::vector<EventRuns> bands(bands_for(grid), EventRuns(grid, source.kinds()));
  const double observations_s = source.observe(
      events, world_from_camera, bands.size(),
      [&](std::size_t band, std::span<const IntensityObservation> part) { bands[band].add(part); },
      [&](double fraction) {
        if (progress) progress(kObservationsFraction * fraction);
      });
  {
    const ScopedTimer clock(sort_s);
    parallel_for(bands.size(), [&](std::size_t band) {
      bands[band].sort_by_run(static_cast<float>(options_.merge_radius_px));
    });
  }
  ImageF image;
  IntensitySystem system(grid.width(), grid.height(), grid.wraps(), bands.size());
  system.set_level_weight(1 / (kLevelSigma * kLevelSigma));
  for (int round = 0; round < kRounds; ++round) {
    {
      const ScopedTimer clock(assembly_s);
      system.clear();
      parallel_for(bands.size(), [&](std::size_t band) {
        add_observations(system, band, grid, bands[band], image,
                         static_cast<float>(options_.bound_sigma));
      });
      add_smoothness(system, grid, options_, image);
    }
    {
      const ScopedTimer clock(solve_s);
      image = system.solve(kIterations, options_.tolerance, image).image;
    }
    if (progress)
      progress(kObservationsFraction + (1 - kObservationsFraction) * (round + 1) / kRounds);
  }
  Reconstruction result;
  result.log_image = std::move(image);
  subtract_mean(result.log_image);
  set_gradient(result, grid, gradient_states(grid, result.log_image, bands));
  for (const EventRuns& band : bands) result.observations += band.size();
  result.stages_s = {{"observations", observations_s},
                     {"sort", sort_s},
                     {"assembly", assembly_s},
                     {"solve", solve_s}};
  return result;
}

}  // namespace saccade
