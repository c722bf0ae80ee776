#include "estimator/depth/depth_config.h"

#include <array>
#include <span>

#include "core/check.h"
#include "core/config/method_table.h"

namespace saccade {
namespace {

using Method = DepthConfig::Method;
using DepthMethodRow = config::MethodRow<DepthConfig, DepthEstimator, const PinholeCamera&, double>;

void describe_thesis(config::Fields& fields, DepthConfig& config) {
  describe(fields, config.thesis);
}

void describe_rays(config::Fields& fields, DepthConfig& config) { describe(fields, config.rays); }

std::unique_ptr<DepthEstimator> make_thesis(const DepthConfig& config, const PinholeCamera& camera,
                                            double mean_depth_m) {
  return std::make_unique<ThesisDepth>(config.thesis, config.limits, camera, mean_depth_m);
}

std::unique_ptr<DepthEstimator> make_rays(const DepthConfig& config, const PinholeCamera& camera,
                                          double) {
  return std::make_unique<RayDepth>(config.rays, config.limits, camera);
}

std::unique_ptr<DepthEstimator> make_sweep(const DepthConfig& config, const PinholeCamera& camera,
                                           double) {
  return std::make_unique<SweepDepth>(config.limits, camera);
}

/// A new method is a pair of files, its options in DepthConfig and a row here.
constexpr DepthMethodRow kDepthMethods[] = {
    {.name = Method::kThesis,
     .help = "Keypoints of a reference event frame, searched along epipolar lines and filtered "
             "(thesis chapter 5).",
     .describe = describe_thesis,
     .make = make_thesis},
    {.name = Method::kRays,
     .help = "Edge points (edgels) of a space sweep, each refined by a regression over the rays of "
             "the events near it.",
     .describe = describe_rays,
     .make = make_rays},
    {.name = Method::kSweep,
     .help = "Votes of all rays on planes of constant inverse depth (EMVS), the baseline.",
     .describe = nullptr,
     .make = make_sweep},
};

}  // namespace

std::vector<std::string_view> depth_method_names() {
  std::vector<std::string_view> names;
  for (const DepthMethodRow& row : kDepthMethods) names.push_back(row.name);
  return names;
}

void describe_depth_range(config::Fields& fields, DepthLimits& limits, std::string_view help) {
  std::array<double, 2> range{limits.near_m, limits.far_m};
  fields.value("depth_range_m", range, help).range(1e-3, 1e6);
  fields.expect(range[0] < range[1], "depth_range_m", "the first depth must be below the second");
  limits.near_m = range[0];
  limits.far_m = range[1];
}

void describe(config::Fields& fields, DepthConfig& config) {
  config::describe_method(fields, "method", config.method,
                          std::span<const DepthMethodRow>(kDepthMethods), config,
                          "Method that estimates depth.");
  describe_depth_range(fields, config.limits,
                       "Nearest and farthest depth that may occur, in metres. A wide range costs "
                       "time and lets more wrong depths through.");
  fields.group(
      "window",
      [&](config::Fields& f) {
        describe(f, config.window);
        f.value("parallax_px", config.parallax_px,
                "Windows over which the camera's translation moves the image by less than this, in "
                "pixels at the mean depth of the scene, are joined with the next ones, five at "
                "most, since a slow camera needs longer to tell depths; not where it turns by more "
                "than half its field of view. 0 joins none.")
            .range(0, 1000);
      },
      "Part of the events from which one view is estimated.");
  fields.value("seed", config.seed, "Without effect: this module draws no random numbers.");
}

std::unique_ptr<DepthEstimator> make_depth_estimator(const DepthConfig& config,
                                                     const PinholeCamera& camera,
                                                     double mean_depth_m) {
  SACCADE_CHECK(mean_depth_m > 0);
  return config::find_method(std::span<const DepthMethodRow>(kDepthMethods), config.method)
      .make(config, camera, mean_depth_m);
}

}  // namespace saccade
