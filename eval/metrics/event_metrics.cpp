#include "eval/metrics/event_metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "core/check.h"
#include "core/io/events/labels_h5.h"

namespace saccade {
namespace {

/// Pairs further apart than this say nothing of the time error.
constexpr TimeNs kFarthest_ns = 1'000'000;

/// The events of each pixel and polarity, in order of time.
class CellOrder {
 public:
  CellOrder(std::span<const Event> events, std::size_t width, std::size_t cells)
      : begins_(cells + 1), order_(events.size()) {
    const auto cell = [width](const Event& event) {
      return 2 * (event.y * width + event.x) + (event.polarity > 0 ? 1 : 0);
    };
    for (const Event& event : events) ++begins_[cell(event) + 1];
    std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
    std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
    for (std::size_t i = 0; i < events.size(); ++i) order_[next[cell(events[i])]++] = i;
  }

  [[nodiscard]] std::span<const std::size_t> of(std::size_t cell) const {
    return std::span(order_).subspan(begins_[cell], begins_[cell + 1] - begins_[cell]);
  }

 private:
  std::vector<std::size_t> begins_, order_;
};

/// use(i, k) for each pair of a cell: the earliest two that are left are one where they are within
/// the tolerance, else the earlier has no partner.
template <class Use>
void pair_in_order(std::span<const Event> first, std::span<const std::size_t> of_first,
                   std::span<const Event> second, std::span<const std::size_t> of_second,
                   TimeNs tolerance_ns, const Use& use) {
  for (std::size_t i = 0, k = 0; i < of_first.size() && k < of_second.size();) {
    const TimeNs dt_ns = first[of_first[i]].t_ns - second[of_second[k]].t_ns;
    if (std::abs(dt_ns) <= tolerance_ns) use(of_first[i], of_second[k]);
    if (dt_ns <= tolerance_ns) ++i;
    if (dt_ns >= -tolerance_ns) ++k;
  }
}

/// The nearest pairs of a cell first, by octaves: those of a tolerance among the events that half of
/// it has left.
void add_nearest(std::span<const Event> first, std::vector<std::size_t> of_first,
                 std::span<const Event> second, std::vector<std::size_t> of_second,
                 std::vector<TimeNs>& dt_ns) {
  std::vector<std::size_t> paired_first, paired_second;
  const auto drop = [](const std::vector<std::size_t>& paired, std::vector<std::size_t>& left) {
    std::vector<std::size_t> rest;
    std::set_difference(left.begin(), left.end(), paired.begin(), paired.end(),
                        std::back_inserter(rest));
    left = std::move(rest);
  };
  for (TimeNs tolerance_ns = 1; !of_first.empty() && !of_second.empty();
       tolerance_ns = std::min(2 * tolerance_ns, kFarthest_ns)) {
    paired_first.clear();
    paired_second.clear();
    pair_in_order(first, of_first, second, of_second, tolerance_ns,
                  [&](std::size_t i, std::size_t k) {
                    paired_first.push_back(i);
                    paired_second.push_back(k);
                    dt_ns.push_back(first[i].t_ns - second[k].t_ns);
                  });
    if (tolerance_ns == kFarthest_ns) break;
    if (paired_first.empty()) continue;
    drop(paired_first, of_first);
    drop(paired_second, of_second);
  }
}

/// Counts of one stream: its events, and those with a partner.
struct Share {
  std::size_t matched = 0;
  std::size_t all = 0;

  [[nodiscard]] std::optional<double> value() const {
    if (all == 0) return std::nullopt;
    return static_cast<double>(matched) / static_cast<double>(all);
  }
};

template <class Choose>
Share share_of(std::span<const Event> events, const std::vector<bool>& matched,
               const Choose& choose) {
  Share share;
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (!choose(i)) continue;
    ++share.all;
    share.matched += matched[i] ? 1 : 0;
  }
  return share;
}

std::optional<double> ratio(std::size_t part, std::size_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

void score_polarities(const ComparedEvents& events, const ComparedEvents& truth,
                      const MatchedEvents& matched, Metrics& metrics) {
  for (const auto& [name, polarity] : {std::pair{"on", 1}, {"off", -1}}) {
    const auto of = [polarity = polarity](std::span<const Event> stream) {
      return [stream, polarity](std::size_t i) { return stream[i].polarity == polarity; };
    };
    const Share found = share_of(events.events, matched.first[kMainTolerance], of(events.events));
    const Share known = share_of(truth.events, matched.second[kMainTolerance], of(truth.events));
    const std::string prefix = fmt::format("events.{}.", name);
    metrics.set(prefix + "ratio", ratio(found.all, known.all));
    metrics.set(prefix + "precision_10us", found.value());
    metrics.set(prefix + "recall_10us", known.value());
  }
}

void score_origins(const ComparedEvents& stream, const std::vector<bool>& matched,
                   const std::string& key, Metrics& metrics) {
  if (stream.origin.empty()) return;
  SACCADE_CHECK(stream.origin.size() == stream.events.size());
  for (std::size_t origin = 0; origin < kEventOriginNames.size(); ++origin) {
    const Share share =
        share_of(stream.events, matched, [&](std::size_t i) { return stream.origin[i] == origin; });
    if (share.all > 0)
      metrics.set(fmt::format("events.origin.{}.{}", kEventOriginNames[origin], key),
                  share.value());
  }
}

/// Of some values, > 0 of them: the least that at least the fraction `quantile` does not exceed.
double quantile_us(std::vector<TimeNs>& values_ns, double quantile) {
  const auto rank =
      static_cast<std::size_t>(std::ceil(quantile * static_cast<double>(values_ns.size()))) - 1;
  const auto at = values_ns.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values_ns.begin(), at, values_ns.end());
  return 1e-3 * static_cast<double>(*at);
}

void score_times(std::vector<TimeNs> dt_ns, Metrics& metrics) {
  const bool is_known = !dt_ns.empty();
  const auto set = [&](const char* key, double quantile) {
    metrics.set(key, is_known ? std::optional(quantile_us(dt_ns, quantile)) : std::nullopt);
  };
  set("events.median_signed_dt_us", 0.5);
  for (TimeNs& dt : dt_ns) dt = std::abs(dt);
  set("events.median_dt_us", 0.5);
  set("events.p99_dt_us", 0.99);
}

}  // namespace

MatchedEvents match_events(std::span<const Event> first, std::span<const Event> second) {
  std::size_t width = 1, height = 1;
  for (const std::span<const Event> events : {first, second})
    for (const Event& event : events) {
      width = std::max<std::size_t>(width, event.x + 1U);
      height = std::max<std::size_t>(height, event.y + 1U);
    }
  const std::size_t cells = 2 * width * height;
  const CellOrder in_first(first, width, cells);
  const CellOrder in_second(second, width, cells);
  MatchedEvents matched;
  for (std::size_t k = 0; k < kMatchTolerances.size(); ++k) {
    matched.first[k].resize(first.size());
    matched.second[k].resize(second.size());
  }
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const auto a = in_first.of(cell);
    const auto b = in_second.of(cell);
    if (a.empty() || b.empty()) continue;
    for (std::size_t k = 0; k < kMatchTolerances.size(); ++k)
      pair_in_order(first, a, second, b, kMatchTolerances[k].ns, [&](std::size_t i, std::size_t m) {
        matched.first[k][i] = true;
        matched.second[k][m] = true;
      });
    add_nearest(first, {a.begin(), a.end()}, second, {b.begin(), b.end()}, matched.dt_ns);
  }
  return matched;
}

Metrics score_events(const ComparedEvents& events, const ComparedEvents& truth,
                     const MatchedEvents& matched) {
  Metrics metrics;
  metrics.set("events.count", static_cast<double>(events.events.size()));
  metrics.set("events.true_count", static_cast<double>(truth.events.size()));
  metrics.set("events.ratio", ratio(events.events.size(), truth.events.size()));
  const auto all = [](std::size_t) { return true; };
  for (std::size_t k = 0; k < kMatchTolerances.size(); ++k) {
    const std::string_view name = kMatchTolerances[k].name;
    metrics.set(fmt::format("events.precision_{}", name),
                share_of(events.events, matched.first[k], all).value());
    metrics.set(fmt::format("events.recall_{}", name),
                share_of(truth.events, matched.second[k], all).value());
  }
  score_polarities(events, truth, matched, metrics);
  score_origins(events, matched.first[kMainTolerance], "precision_10us", metrics);
  score_origins(truth, matched.second[kMainTolerance], "recall_10us", metrics);
  score_times(matched.dt_ns, metrics);
  return metrics;
}

}  // namespace saccade
