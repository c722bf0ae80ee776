#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "core/config/fields.h"
#include "estimator/reconstruction/equations/equation_reconstruction.h"
#include "estimator/reconstruction/gradient/gradient_reconstruction.h"
#include "estimator/reconstruction/image_solver.h"

namespace saccade {

/// The choice among the methods of the table in image_methods.cpp, of reconstruct and mosaic.
struct ImageMethodOptions {
  static constexpr std::string_view kGradient = "gradient", kEquations = "equations";

  std::string method{kGradient};
  GradientOptions gradient;
  EquationOptions equations;

  /// Those of the method.
  [[nodiscard]] ObservationOptions& observations() {
    return method == kEquations ? equations.observations : gradient.observations;
  }
  [[nodiscard]] const ObservationOptions& observations() const {
    return method == kEquations ? equations.observations : gradient.observations;
  }
};

/// The keys `method`, `observations` and those of the method. `has_surfaces`: of views with depth, not
/// of a panorama.
void describe(config::Fields& fields, ImageMethodOptions& options, bool has_surfaces);

[[nodiscard]] std::unique_ptr<ImageSolver> make_image_solver(const ImageMethodOptions& options);

}  // namespace saccade
