#include "estimator/reconstruction/contrast_thresholds.h"

#include <fmt/core.h>

#include "core/error.h"

namespace saccade {
namespace {

double contrast_of(const std::optional<double>& configured, const std::optional<double>& stated,
                   const Dataset& dataset, const char* key) {
  if (configured) return *configured;
  if (!stated)
    throw InputError(dataset.folder().string(),
                     fmt::format("does not state its contrast thresholds; state {}", key));
  return *stated;
}

}  // namespace

void describe_contrast(config::Fields& fields, std::optional<double>& on,
                       std::optional<double>& off) {
  fields
      .value(
          "contrast_on", on,
          "Contrast threshold C+ of ON events, in log units; ~ takes the dataset's. A wrong value "
          "scales the contrast of the image.")
      .above(0);
  fields
      .value("contrast_off", off,
             "Contrast threshold C- of OFF events, in log units; ~ takes the dataset's.")
      .above(0);
}

ContrastThresholds contrast_thresholds(const std::optional<double>& on,
                                       const std::optional<double>& off, const Dataset& dataset) {
  const DatasetFacts& facts = dataset.facts();
  return {contrast_of(on, facts.contrast_on, dataset, "contrast_on"),
          contrast_of(off, facts.contrast_off, dataset, "contrast_off")};
}

}  // namespace saccade
