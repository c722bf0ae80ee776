#include "estimator/registry.h"

#include "core/error.h"
#include "estimator/tracking/track_module.h"

namespace saccade {
namespace {

constexpr Module kModules[] = {
    {"track", "pose of the camera against a known map (thesis chapter 4)", run_track,
     print_track_config},
};

}  // namespace

std::span<const Module> modules() { return kModules; }

const Module& find_module(const std::string& name) {
  std::string known;
  for (const Module& module : modules()) {
    if (name == module.name) return module;
    known += known.empty() ? module.name : std::string(", ") + module.name;
  }
  throw InputError("MODULE", "there is no estimator '" + name + "'; there are: " + known);
}

RunSummary run_module(const std::string& name, const RunRequest& request) {
  return find_module(name).run(request);
}

}  // namespace saccade
