#include "eval/refined_ratio.h"

#include <filesystem>
#include <string>

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Those that are zero for a perfect estimate, and of which a quotient says something.
constexpr const char* kErrors[] = {"trajectory.dt_rel_percent.mean",
                                   "trajectory.dt_rel_percent.rmse",
                                   "trajectory.dtheta_deg.mean",
                                   "trajectory.dtheta_deg.rmse",
                                   "trajectory.none.ate_rmse_m",
                                   "trajectory.se3.ate_rmse_m",
                                   "trajectory.sim3.ate_rmse_m",
                                   "depth.rel_mean",
                                   "depth.rel_median",
                                   "depth.strict.rel_mean",
                                   "depth.strict.rel_median"};

bool is_same_folder(const fs::path& a, const fs::path& b) {
  return !a.empty() && fs::weakly_canonical(a) == fs::weakly_canonical(b);
}

bool is_same_dataset(const RunRecord& a, const RunRecord& b) {
  if (!a.dataset_sha256.empty() && !b.dataset_sha256.empty())
    return a.dataset_sha256 == b.dataset_sha256;
  return is_same_folder(a.dataset, b.dataset);
}

/// Module of the run that a refined run came from; empty where that is gone.
std::string refined_module(const RunRecord& refined) {
  const fs::path record = refined.from / "run.yaml";
  return fs::exists(record) ? read_run_record(record).module : std::string();
}

}  // namespace

Metrics refined_ratios(const Metrics& scores, const Metrics& refined) {
  Metrics ratios;
  for (const char* key : kErrors) {
    if (!scores.values().contains(key) || !refined.values().contains(key)) continue;
    const std::optional<double> ours = scores.get(key), best = refined.get(key);
    std::optional<double> ratio;
    if (ours && best && *best > 0) ratio = *ours / *best;
    ratios.set(std::string("refined_ratio.") + key, ratio);
  }
  return ratios;
}

const RunFolder* find_refined(const RunFolder& run, std::span<const RunFolder* const> runs) {
  if (run.record.module == "refine") return nullptr;
  const RunFolder* of_same_module = nullptr;
  for (const RunFolder* other : runs) {
    if (other->record.module != "refine" || !is_same_dataset(run.record, other->record)) continue;
    if (is_same_folder(other->record.from, run.folder)) return other;
    if (of_same_module == nullptr && refined_module(other->record) == run.record.module)
      of_same_module = other;
  }
  return of_same_module;
}

}  // namespace saccade
