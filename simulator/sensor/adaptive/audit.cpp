#include "simulator/sensor/adaptive/audit.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/process/parallel.h"
#include "core/random.h"

namespace saccade {
namespace {

/// With fewer tiles the intervals say little.
constexpr std::size_t kLeastTiles = 32;
constexpr std::uint64_t kTileStream = 0x6175646974;  // of the random numbers; any constant
constexpr std::uint64_t kBootstrapStream = kTileStream + 1;
constexpr std::size_t kResamples = 1000;
/// Of a normal distribution, two-sided 95 %.
constexpr double kZ = 1.96;

std::vector<std::size_t> drawn_tiles(std::size_t count, double fraction, std::uint64_t seed) {
  if (fraction <= 0) return {};
  const auto wanted = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(count)));
  const std::size_t parts = std::min(count, std::max(kLeastTiles, wanted));
  const Random random(seed);
  std::vector<std::size_t> tiles;
  for (std::size_t k = 0; k < parts; ++k) {
    const std::size_t first = k * count / parts;
    const std::size_t last = (k + 1) * count / parts;
    tiles.push_back(first + random.below(last - first, kTileStream, k));
  }
  return tiles;
}

/// The pixels as they are, without what is behind them.
EventOptions within_pixels(const EventOptions& options) {
  EventOptions result = options;
  result.noise.latency = {};
  result.noise.readout = {};
  result.sampling = Sampling::kExact;
  return result;
}

/// Steps and tolerances of a dense reference are finer by these factors. Then crossings are located
/// within one tolerance, and what passes within a sixteenth of a step is missed.
constexpr double kDenseSteps = 16;
constexpr double kDenseTolerances = 4;

EventOptions densely(EventOptions options) {
  options.max_step_px /= kDenseSteps;
  options.time_tolerance_us /= kDenseTolerances;
  return options;
}

double fraction_of(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 1 : static_cast<double>(part) / static_cast<double>(whole);
}

double p99_us(const MatchCounts& counts) {
  std::uint64_t total = 0;
  for (const std::uint32_t n : counts.dt) total += n;
  std::uint64_t below = 0;
  for (std::size_t bin = 0; bin < counts.dt.size(); ++bin) {
    below += counts.dt[bin];
    if (total > 0 && below * 100 >= total * 99) return MatchCounts::dt_us(bin);
  }
  return 0;
}

/// What passes unseen takes so many events with it at once, and few audited tiles may have seen none
/// of it: of the events missed in Office and Desk, the mean one is missed together with 5 and 18.
constexpr double kMissedTogether = 10;

/// Wilson's interval of a share of `whole` events, were they independent in such groups.
AuditFigure wilson(double share, std::uint64_t whole) {
  if (whole == 0) return {share, 0, 1};
  const double n = static_cast<double>(whole) / kMissedTogether;
  const double centre = (share + kZ * kZ / (2 * n)) / (1 + kZ * kZ / n);
  const double half =
      kZ / (1 + kZ * kZ / n) * std::sqrt(share * (1 - share) / n + kZ * kZ / (4 * n * n));
  return {share, std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

}  // namespace

EventMatcher& Audit::AuditedTile::matcher(const SensedEvent& event) {
  const int pixel = (event.y - tile.y0) * tile.width + (event.x - tile.x0);
  return matchers[static_cast<std::size_t>(2 * pixel + (event.polarity > 0 ? 1 : 0))];
}

Audit::Audit(const Scene& scene, const Spline& world_from_camera, const PinholeCamera& camera,
             const EventOptions& options, std::uint64_t seed)
    : rays_(camera, options.samples_per_pixel, options.pixel_side),
      seed_(seed),
      dense_options_(densely(within_pixels(options))),
      noise_(options, seed) {
  index_ = drawn_tiles(rays_.tile_count(), options.audit_fraction, seed);
  if (index_.empty()) return;
  for (const std::size_t i : index_) {
    const Tile tile = rays_.tile(i);
    tiles_.push_back({tile, std::vector<EventMatcher>(2 * tile.pixels()), {}});
  }
  if (audit_reference(scene) == AuditReference::kExact) {
    exact_.emplace(scene, world_from_camera, camera, within_pixels(options), seed, index_);
    return;
  }
  for (const std::size_t i : index_)
    dense_.push_back(std::make_unique<AdaptiveTile>(scene, rays_, dense_options_, noise_, seed, i));
}

void Audit::sense(const AdaptiveSlice& slice,
                  const std::function<double(std::size_t)>& around_px_s) {
  if (dense_.empty()) return;
  parallel_for(dense_.size(), [&](std::size_t k) {
    if (!has_started_) dense_[k]->start(slice);
    dense_[k]->advance(slice, {around_px_s(index_[k]), true});
    SensedEvents events;
    dense_[k]->take_events(events);
    for (const SensedEvent& event : events) tiles_[k].matcher(event).add_exact(event.t_ns);
    tiles_[k].counts.exact += events.size();
  });
  has_started_ = true;
}

AuditReference audit_reference(const Scene& scene) {
  return scene.is_animated() ? AuditReference::kDense : AuditReference::kExact;
}

Audit::AuditedTile* Audit::audited(std::size_t tile) {
  const auto found = std::lower_bound(index_.begin(), index_.end(), tile);
  if (found == index_.end() || *found != tile) return nullptr;
  return &tiles_[static_cast<std::size_t>(found - index_.begin())];
}

void Audit::add(std::size_t tile, std::span<const SensedEvent> events) {
  AuditedTile* const own = audited(tile);
  if (own == nullptr) return;
  for (const SensedEvent& event : events) own->matcher(event).add_sampled(event.t_ns);
  own->counts.sampled += events.size();
}

void Audit::advance(double t_s, double duration_s) {
  if (tiles_.empty()) return;
  while (exact_ && exact_->reached_s() < t_s)
    exact_->advance(duration_s, [&](std::size_t tile, std::span<const SensedEvent> events) {
      AuditedTile& own = *audited(tile);
      for (const SensedEvent& event : events) own.matcher(event).add_exact(event.t_ns);
      own.counts.exact += events.size();
    });
  // Rounding can put an event on the tick before t_s.
  constexpr TimeNs kTick_ns = 2'000;
  const TimeNs until_ns =
      t_s < duration_s ? ns_from_seconds(t_s) - kTick_ns : std::numeric_limits<TimeNs>::max() / 2;
  for (AuditedTile& tile : tiles_)
    for (EventMatcher& matcher : tile.matchers) matcher.advance(until_ns, tile.counts);
}

std::vector<AuditedCounts> Audit::counts() const {
  std::vector<AuditedCounts> counts;
  for (const AuditedTile& tile : tiles_) counts.push_back({tile.tile.pixels(), tile.counts});
  return counts;
}

AuditResult audit_result(std::span<const AuditedCounts> tiles, std::uint64_t seed) {
  AuditResult result;
  MatchCounts all;
  for (const AuditedCounts& tile : tiles) {
    result.pixels += tile.pixels;
    all.add(tile.counts);
  }
  if (tiles.empty()) return result;
  result.exact_events = all.exact;
  result.sampled_events = all.sampled;

  using Figure = std::function<double(const MatchCounts&)>;
  const Random random(seed);
  const double n = static_cast<double>(tiles.size());
  // The spread of a few clusters is underestimated by their own; that of n - 1 of them is not.
  const double widen = std::sqrt(n / std::max(n - 1, 1.0)) * (1 + 1.2 / n);
  const auto measure = [&](const Figure& figure) {
    const double value = figure(all);
    std::vector<double> samples(kResamples);
    for (std::size_t r = 0; r < kResamples; ++r) {
      MatchCounts resampled;
      for (std::size_t k = 0; k < tiles.size(); ++k)
        resampled.add(tiles[random.below(tiles.size(), kBootstrapStream + r, k)].counts);
      samples[r] = figure(resampled);
    }
    std::sort(samples.begin(), samples.end());
    const double low = samples[kResamples * 25 / 1000];
    const double high = samples[kResamples * 975 / 1000 - 1];
    return AuditFigure{value, std::max(0.0, value - widen * (value - std::min(low, value))),
                       value + widen * (std::max(high, value) - value)};
  };
  const auto share = [&](const Figure& figure, std::uint64_t whole) {
    AuditFigure measured = measure(figure);
    const AuditFigure least = wilson(measured.value, whole);
    measured.low = std::clamp(std::min(measured.low, least.low), 0.0, 1.0);
    measured.high = std::clamp(std::max(measured.high, least.high), 0.0, 1.0);
    return measured;
  };
  const auto precision = [&](std::size_t tolerance) {
    return share([=](const MatchCounts& c) { return fraction_of(c.matched[tolerance], c.sampled); },
                 all.sampled);
  };
  const auto recall = [&](std::size_t tolerance) {
    return share([=](const MatchCounts& c) { return fraction_of(c.matched[tolerance], c.exact); },
                 all.exact);
  };
  result.precision_1us = precision(0);
  result.recall_1us = recall(0);
  result.precision_10us = precision(1);
  result.recall_10us = recall(1);
  result.p99_dt_us = measure(p99_us);
  return result;
}

void Audit::save(StateWriter& state) const {
  if (tiles_.empty()) return;
  if (exact_) state.text(exact_->state());
  for (const auto& tile : dense_) tile->save(state);
  for (const AuditedTile& tile : tiles_) {
    for (const EventMatcher& matcher : tile.matchers) matcher.save(state);
    state.value(tile.counts);
  }
}

void Audit::load(StateReader& state) {
  if (tiles_.empty()) return;
  if (exact_) exact_->resume(state.text());
  for (const auto& tile : dense_) tile->load(state);
  has_started_ = true;
  for (AuditedTile& tile : tiles_) {
    for (EventMatcher& matcher : tile.matchers) matcher.load(state);
    state.value(tile.counts);
  }
}

}  // namespace saccade
