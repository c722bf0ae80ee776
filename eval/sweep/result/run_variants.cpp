#include "eval/sweep/result/run_variants.h"

#include "core/config/config.h"
#include "eval/sweep/plan/plan.h"
#include "eval/sweep/plan/sweep_config.h"

namespace saccade {

RunVariants run_variants(const std::filesystem::path& store) {
  const std::filesystem::path folder =
      std::filesystem::absolute(store).lexically_normal().parent_path().parent_path();
  const std::filesystem::path file = folder / "sweep.yaml";
  RunVariants variants;
  if (!std::filesystem::exists(file)) return variants;
  const auto sweep = config::read<SweepConfig>(config::load(file));
  for (const SweepJob& job : plan_sweep(sweep, folder).runs)
    variants.emplace(job.output.filename().string(), job.point.variant);
  return variants;
}

}  // namespace saccade
