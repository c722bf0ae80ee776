#include "eval/sweep/status.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/error.h"
#include "eval/sweep/plan/plan.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr double kRecentS = 600;
constexpr std::size_t kShownFailures = 10;

/// The last line that `saccade` wrote of a failure into a log; empty where there is none.
std::string failure_in(const fs::path& log) {
  constexpr std::string_view kProgram = "saccade: ";
  std::ifstream stream(log);
  std::string message, last;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with(kProgram)) message = line.substr(kProgram.size());
    if (!line.empty()) last = line;
  }
  // A notice in the middle of a log is no failure: that is the last line of the command.
  return last.starts_with(kProgram) ? message : "";
}

struct Counts {
  std::size_t done = 0, running = 0, waiting = 0;
  std::vector<std::pair<std::string, std::string>> failed;  ///< job, reason
  std::vector<double> ages_s;                               ///< of the records of the last kRecentS
};

void count(const SweepJob& job, const fs::path& folder, Counts& counts) {
  const fs::path job_folder = folder / "jobs" / job.name;
  std::error_code none;
  const auto written = fs::last_write_time(job_folder / "job.yaml", none);
  if (!none) {
    ++counts.done;
    const double age_s =
        std::chrono::duration<double>(fs::file_time_type::clock::now() - written).count();
    if (age_s <= kRecentS) counts.ages_s.push_back(age_s);
    return;
  }
  if (!fs::exists(job_folder / "log.txt")) {
    ++counts.waiting;
    return;
  }
  const std::string failure = failure_in(job_folder / "log.txt");
  if (failure.empty())
    ++counts.running;
  else
    counts.failed.emplace_back(job.name, failure);
}

std::string rate_text(const Counts& counts) {
  if (counts.ages_s.size() < 2) return "";
  const double span_s = *std::max_element(counts.ages_s.begin(), counts.ages_s.end());
  if (span_s <= 0) return "";
  const double per_s = static_cast<double>(counts.ages_s.size()) / span_s;
  const auto left = static_cast<double>(counts.running + counts.waiting);
  std::string text = fmt::format("{:.3g} jobs/s over the last {:.0f} s", per_s, span_s);
  if (left > 0) text += fmt::format(", about {:.0f} s left", left / per_s);
  return text + "\n";
}

}  // namespace

std::string sweep_status(const SweepConfig& sweep, const fs::path& folder) {
  if (!fs::exists(folder / "sweep.yaml"))
    throw InputError(folder.string(), "holds no sweep (no sweep.yaml)");
  const SweepPlan plan = plan_sweep(sweep, folder);
  Counts counts;
  for (const auto* jobs : {&plan.simulations, &plan.runs})
    for (const SweepJob& job : *jobs) count(job, folder, counts);
  std::string text = fmt::format("{} jobs: {} done, {} running, {} failed, {} waiting\n",
                                 plan.simulations.size() + plan.runs.size(), counts.done,
                                 counts.running, counts.failed.size(), counts.waiting);
  text += rate_text(counts);
  for (std::size_t i = 0; i < std::min(counts.failed.size(), kShownFailures); ++i)
    text += fmt::format("failed: {}: {}\n", counts.failed[i].first, counts.failed[i].second);
  if (counts.failed.size() > kShownFailures)
    text += fmt::format("and {} more\n", counts.failed.size() - kShownFailures);
  return text;
}

std::string sweep_jobs_json(const SweepConfig& sweep, const fs::path& folder) {
  using Json = nlohmann::ordered_json;
  const SweepPlan plan = plan_sweep(sweep, folder);
  std::vector<std::pair<int, Json>> jobs;
  const auto add = [&](const SweepJob& job, const std::vector<SweepJob>& siblings,
                       int first_stage) {
    Json needs = Json::array();
    if (job.made_by) needs.push_back(plan.simulations[*job.made_by].name);
    for (const std::size_t source : job.sources) needs.push_back(siblings[source].name);
    Json one{
        {"name", job.name},
        {"needs", needs},
        {"output", job.output.string()},
        {"scores", job.scores.empty() ? Json(nullptr) : Json(job.scores.string())},
        {"log", (fs::absolute(folder).lexically_normal() / "jobs" / job.name / "log.txt").string()},
        {"commands", job.commands}};
    jobs.emplace_back(first_stage + job.stage, std::move(one));
  };
  for (const SweepJob& job : plan.simulations) add(job, plan.simulations, 0);
  const int stages = SweepPlan::stages(plan.simulations);
  for (const SweepJob& job : plan.runs) add(job, plan.runs, stages);
  std::stable_sort(jobs.begin(), jobs.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  Json list = Json::array();
  for (auto& [stage, job] : jobs) list.push_back(std::move(job));
  return Json{{"folder", fs::absolute(folder).lexically_normal().string()},
              {"threads", sweep.threads},
              {"jobs", list}}
             .dump(1) +
         "\n";
}

}  // namespace saccade
