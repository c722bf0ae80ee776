#include "estimator/depth/depth_config.h"

#include <span>
#include <type_traits>

#include "core/check.h"
#include "core/config/method_table.h"

namespace saccade {
namespace {

using Method = DepthConfig::Method;
using DepthMethodRow = config::MethodRow<DepthConfig, DepthEstimator, const PinholeCamera&, double>;

template <auto kOptions>
void describe_options(config::Fields& fields, DepthConfig& config) {
  describe(fields, config.*kOptions);
}

template <class Depth, auto kOptions>
std::unique_ptr<DepthEstimator> make(const DepthConfig& config, const PinholeCamera& camera,
                                     double mean_depth_m) {
  const auto& options = config.*kOptions;
  if constexpr (std::is_constructible_v<Depth, decltype(options), DepthLimits, PinholeCamera,
                                        double>)
    return std::make_unique<Depth>(options, config.limits, camera, mean_depth_m);
  else
    return std::make_unique<Depth>(options, config.limits, camera);
}

/// A new method is a pair of files, its options in DepthConfig and a row here.
constexpr DepthMethodRow kDepthMethods[] = {
    {.name = Method::kThesis,
     .help = "Keypoints of a reference event frame, searched along epipolar lines and filtered "
             "(thesis chapter 5).",
     .describe = describe_options<&DepthConfig::thesis>,
     .make = make<ThesisDepth, &DepthConfig::thesis>},
    {.name = Method::kRays,
     .help = "Edge points (edgels) of a space sweep, each refined by a regression over the rays of "
             "the events near it.",
     .describe = describe_options<&DepthConfig::rays>,
     .make = make<RayDepth, &DepthConfig::rays>},
    {.name = Method::kSweep,
     .help = "Votes of all rays on planes of constant inverse depth (EMVS), the baseline.",
     .describe = describe_options<&DepthConfig::sweep>,
     .make = make<SweepDepth, &DepthConfig::sweep>},
};

void describe_limits(config::Fields& fields, DepthLimits& limits) {
  fields.value("near", limits.near_m, "Smallest depth that may occur, in metres.").range(1e-3, 1e6);
  fields.value("far", limits.far_m, "Largest depth that may occur, in metres.").range(1e-3, 1e6);
  fields.expect(limits.near_m < limits.far_m, "near", "must be below far");
}

}  // namespace

void describe_depth_method(config::Fields& fields, DepthConfig& config) {
  config::describe_method(fields, "method", config.method,
                          std::span<const DepthMethodRow>(kDepthMethods), config,
                          "Method that estimates depth.");
  fields.group(
      "range_m", [&](config::Fields& f) { describe_limits(f, config.limits); },
      "Depths that may occur; a wide range costs time and lets more wrong depths through.");
}

void describe(config::Fields& fields, DepthConfig& config) {
  describe_depth_method(fields, config);
  fields.group(
      "window", [&](config::Fields& f) { describe(f, config.window); },
      "Part of the events from which one view is estimated.");
  fields.value("seed", config.seed, "Seed of random numbers; no method draws any yet.");
}

std::unique_ptr<DepthEstimator> make_depth_estimator(const DepthConfig& config,
                                                     const PinholeCamera& camera,
                                                     double mean_depth_m) {
  SACCADE_CHECK(mean_depth_m > 0);
  return config::find_method(std::span<const DepthMethodRow>(kDepthMethods), config.method)
      .make(config, camera, mean_depth_m);
}

}  // namespace saccade
