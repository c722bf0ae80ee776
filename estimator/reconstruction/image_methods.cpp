#include "estimator/reconstruction/image_methods.h"

#include <span>

#include "core/config/method_table.h"

namespace saccade {
namespace {

using ImageMethodRow = config::MethodRow<ImageMethodOptions, ImageSolver>;

template <auto kOptions>
void describe_method_options(config::Fields& fields, ImageMethodOptions& options) {
  describe(fields, options.*kOptions);
}

template <class Solver, auto kOptions>
std::unique_ptr<ImageSolver> make_solver(const ImageMethodOptions& options) {
  return std::make_unique<Solver>(options.*kOptions);
}

/// A new method is a pair of files, its options in ImageMethodOptions and a row here.
constexpr ImageMethodRow kImageMethods[] = {
    {.name = ImageMethodOptions::kGradient,
     .help = "A Kalman filter on the gradient of each pixel and Poisson's equation (thesis chapter "
             "6).",
     .describe = describe_method_options<&ImageMethodOptions::gradient>,
     .make = make_solver<GradientReconstruction, &ImageMethodOptions::gradient>},
    {.name = ImageMethodOptions::kEquations,
     .help =
         "Linear equations of the log intensity at and between events, solved by least squares.",
     .describe = describe_method_options<&ImageMethodOptions::equations>,
     .make = make_solver<EquationReconstruction, &ImageMethodOptions::equations>},
};

}  // namespace

void describe(config::Fields& fields, ImageMethodOptions& options, bool has_surfaces) {
  config::describe_method(fields, "method", options.method,
                          std::span<const ImageMethodRow>(kImageMethods), options,
                          "Method that reconstructs the image.");
  fields.group(
      "observations", [&](config::Fields& f) { describe(f, options.observations(), has_surfaces); },
      "Observations of the log intensity by events and by their absence; the defaults depend on "
      "the method.");
}

std::unique_ptr<ImageSolver> make_image_solver(const ImageMethodOptions& options) {
  return config::find_method(std::span<const ImageMethodRow>(kImageMethods), options.method)
      .make(options);
}

}  // namespace saccade
