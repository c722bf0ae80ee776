#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/config/fields.h"
#include "estimator/reconstruction/depth_source.h"
#include "estimator/reconstruction/equation_reconstruction.h"
#include "estimator/reconstruction/gradient_reconstruction.h"
#include "estimator/reconstruction/image_estimator.h"
#include "estimator/run/view_windows.h"

namespace saccade {

/// The configuration of `saccade run reconstruct`; describe() names the keys, ranges and defaults.
struct ReconstructionConfig {
  enum class Method { kGradient, kEquations };

  Method method = Method::kGradient;
  /// The whole as one, at a grey frame that it can be compared with.
  ViewWindowOptions window{
      .duration_s = 3600, .events = 1000000, .reference = ViewWindowOptions::Reference::kFrame};
  DepthSourceOptions depth;
  std::optional<double> contrast_on;  ///< nullopt: the dataset's
  std::optional<double> contrast_off;
  GradientOptions gradient;
  EquationOptions equations;
  std::vector<std::int64_t> growth;  ///< numbers of events after which a picture is kept
  bool figures = false;              ///< of single steps, see write_step_figures()
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, ReconstructionConfig& config);

/// The keys of both methods that say nothing of depth, as a mosaic has them, too.
void describe_levels(config::Fields& fields, LevelOptions& options);
void describe_gradient(config::Fields& fields, GradientOptions& options);
void describe_equations(config::Fields& fields, EquationOptions& options);

/// The part of a configuration that is the method, for other modules that reconstruct: all but
/// window, growth, figures and seed.
void describe_image_method(config::Fields& fields, ReconstructionConfig& config);

/// The method that the configuration names. `camera` with its lens.
[[nodiscard]] std::unique_ptr<ImageEstimator> make_image_estimator(
    const ReconstructionConfig& config, const PinholeCamera& camera);

}  // namespace saccade
