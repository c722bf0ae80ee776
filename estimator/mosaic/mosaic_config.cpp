#include "estimator/mosaic/mosaic_config.h"

#include "estimator/reconstruction/growth.h"
#include "estimator/reconstruction/reconstruction_config.h"

namespace saccade {

void describe(config::Fields& fields, RateOffsetOptions& options) {
  fields.value("estimate", options.estimate,
               "the orientations turn too fast by what makes the events sharpest");
  fields.value("events", options.events, "so many of them are looked at").range(1000, 1e9);
  fields.value("levels", options.levels, "from a panorama that is halved so often, less one")
      .range(1, 8);
  fields.value("most", options.most, "of a component [rad/s]").range(1e-6, 100);
}

void describe(config::Fields& fields, MosaicConfig& config) {
  using Extent = MosaicConfig::Extent;
  using Method = MosaicOptions::Method;
  fields.group(
      "orientation", [&](config::Fields& f) { describe(f, config.orientation); },
      "from the inertial sensor; not used with --poses-from");
  fields.section("rate_offset", config.rate_offset, "what a gyroscope's bias leaves, from events");
  fields
      .value("pixels_per_radian", config.pixels_per_radian,
             "at least so fine; ~ is the camera's focal length")
      .range(1, 10000);
  fields.choice("extent", config.extent, {{"swept", Extent::kSwept}, {"sphere", Extent::kSphere}},
                "what the camera saw, or all directions");
  fields.value("contrast_on", config.contrast_on, "C+ [log units]; ~ is the dataset's").above(0);
  fields.value("contrast_off", config.contrast_off, "C-").above(0);
  MosaicOptions& mosaic = config.mosaic;
  fields.choice("method", mosaic.method,
                {{"gradient", Method::kGradient}, {"equations", Method::kEquations}},
                "how the image is found");
  LevelOptions& levels =
      mosaic.method == Method::kGradient ? mosaic.gradient.levels : mosaic.equations.levels;
  fields.group(
      "levels", [&](config::Fields& f) { describe_levels(f, levels); },
      "what events say about the mosaic");
  if (mosaic.method == Method::kGradient)
    fields.group(
        "gradient", [&](config::Fields& f) { describe_gradient(f, mosaic.gradient); },
        "pixel-wise Kalman filter and Poisson's equation (chapter 6)");
  if (mosaic.method == Method::kEquations)
    fields.group(
        "equations", [&](config::Fields& f) { describe_equations(f, mosaic.equations); },
        "one linear equation per event, least squares");
  fields.value("growth", config.growth, "numbers of events after which a picture is kept");
  check_growth(fields, config.growth);
  fields.value("seed", config.seed, "of random numbers; none are drawn");
}

}  // namespace saccade
