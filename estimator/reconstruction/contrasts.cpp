#include "estimator/reconstruction/contrasts.h"

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

Contrasts contrasts(const std::optional<double>& on, const std::optional<double>& off,
                    const Dataset& dataset) {
  const DatasetFacts& facts = dataset.facts();
  return {contrast_of(on, facts.contrast_on, dataset, "contrast_on"),
          contrast_of(off, facts.contrast_off, dataset, "contrast_off")};
}

}  // namespace saccade
