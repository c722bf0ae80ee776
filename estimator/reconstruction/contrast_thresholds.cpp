#include "estimator/reconstruction/contrast_thresholds.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>

namespace saccade {
namespace {

/// C+ / C- by the numbers of events; few of one polarity say little.
double balance_of(std::span<const Event> events) {
  constexpr double kMost = 4;
  constexpr double kExpectedEvents = 100;  // of either polarity, as if seen before
  const auto on = static_cast<double>(
      std::count_if(events.begin(), events.end(), [](const Event& e) { return e.polarity > 0; }));
  const double off = static_cast<double>(events.size()) - on;
  return std::clamp((off + kExpectedEvents) / (on + kExpectedEvents), 1 / kMost, kMost);
}

}  // namespace

void describe_contrast(config::Fields& fields, std::optional<double>& on,
                       std::optional<double>& off) {
  fields
      .value("contrast_on", on,
             "Contrast threshold C+ of ON events, in log units; ~ takes the dataset's or, where it "
             "states none, finds it up to a common factor by the balance of ON and OFF events. A "
             "wrong "
             "value scales the contrast of the image.")
      .above(0);
  fields
      .value("contrast_off", off,
             "Contrast threshold C- of OFF events, in log units; ~ as with contrast_on.")
      .above(0);
}

ContrastThresholds contrast_thresholds(const std::optional<double>& on,
                                       const std::optional<double>& off, const Dataset& dataset,
                                       std::span<const Event> events) {
  constexpr double kUnknownScale = 0.2;
  const DatasetFacts& facts = dataset.facts();
  const std::optional<double> stated_on = on ? on : facts.contrast_on;
  const std::optional<double> stated_off = off ? off : facts.contrast_off;
  if (stated_on && stated_off) return {*stated_on, *stated_off};
  const double balance = balance_of(events);
  if (stated_off) return {balance * *stated_off, *stated_off, true};
  const double found_on = stated_on.value_or(kUnknownScale);
  return {found_on, found_on / balance, true};
}

std::string found_text(const ContrastThresholds& thresholds) {
  if (!thresholds.is_found) return {};
  return fmt::format(", C+ / C- = {:.2f} by the balance of the events",
                     thresholds.on / thresholds.off);
}

}  // namespace saccade
