#include "estimator/refinement/source_run.h"

#include <fmt/core.h>

#include <map>

#include "core/error.h"
#include "core/io/tables/csv_reader.h"
#include "core/io/trajectory_file.h"
#include "estimator/run/run_writer.h"

namespace saccade {
namespace {

constexpr std::size_t kFewestPoses = 4;

[[noreturn]] void fail_few(const std::string& where) {
  throw InputError(where, fmt::format("holds fewer than {} poses that are not lost: nothing to "
                                      "refine",
                                      kFewestPoses));
}

}  // namespace

SourceRun SourceRun::open(const RunRequest& request, const Dataset& dataset) {
  if (!request.from)
    throw InputError("--from", "name the run of track, depth or odometry to refine: --from RUN");
  SourceRun run;
  run.folder = *request.from;
  const std::filesystem::path record = run.folder / "run.yaml";
  if (!std::filesystem::exists(record))
    throw InputError(run.folder.string(), "is no run folder: it holds no run.yaml (--from)");
  run.record = read_run_record(record);
  if (!run.record.dataset_sha256.empty() && run.record.dataset_sha256 != dataset_hash(dataset)) {
    const std::string then = run.record.dataset.string(), now = dataset.folder().string();
    throw InputError(
        run.folder.string(),
        then == now
            ? fmt::format("is a run over {}, which was written anew since (--from)", now)
            : fmt::format("is a run over {}, which is not the dataset {} (--from)", then, now));
  }
  return run;
}

RunRequest SourceRun::within(const RunRequest& request) const {
  RunRequest part = request;
  if (request.start_s || request.duration_s || !record.window) return part;
  // The end of a window is the time of its last event, which belongs to it.
  constexpr double kHair_s = 1e-9;
  part.start_s = record.window->start_s;
  part.duration_s = record.window->end_s - record.window->start_s + kHair_s;
  return part;
}

config::Document SourceRun::document() const {
  return config::parse(record.config_yaml, (folder / "run.yaml").string() + ": config", folder);
}

std::vector<TrackedPose> SourceRun::poses() const {
  const Trajectory trajectory = read_tum_trajectory(folder / "trajectory.txt");
  std::map<TimeNs, Rigid3> by_time;
  for (const StampedPose& pose : trajectory.poses())
    by_time.emplace(ns_from_seconds(pose.t_s), pose.world_from_camera);
  const CsvColumns rows(folder / "poses.csv");
  const std::size_t t = rows.require("t_s"), status = rows.require("status");
  const std::size_t first = rows.require("first_event_s"), last = rows.require("last_event_s");
  const auto probability = rows.find("probability");
  std::vector<TrackedPose> poses;
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    TrackedPose pose;
    pose.t_ns = ns_from_seconds(rows.number(i, t));
    // Of two poses at one time trajectory.txt holds the first.
    if (!poses.empty() && pose.t_ns <= poses.back().t_ns) continue;
    const auto at = by_time.find(pose.t_ns);
    if (at == by_time.end()) continue;
    pose.world_from_camera = at->second;
    pose.first_ns = ns_from_seconds(rows.number(i, first));
    pose.last_ns = ns_from_seconds(rows.number(i, last));
    if (rows.text(i, status) == "lost") pose.status = TrackStatus::kLost;
    if (probability) pose.probability = rows.number(i, *probability);
    poses.push_back(pose);
  }
  if (poses.size() < kFewestPoses) fail_few(folder.string());
  return poses;
}

std::vector<StampedPose> poses_not_lost(std::span<const TrackedPose> poses, double start_s,
                                        double end_s, const std::string& where) {
  std::vector<StampedPose> path;
  for (const TrackedPose& pose : poses)
    if (pose.status == TrackStatus::kOk)
      path.push_back({seconds_from_ns(pose.t_ns), pose.world_from_camera});
  if (path.size() < kFewestPoses) fail_few(where);
  if (start_s < path.front().t_s)
    path.insert(path.begin(), {start_s, path.front().world_from_camera});
  if (end_s > path.back().t_s) path.push_back({end_s, path.back().world_from_camera});
  return path;
}

}  // namespace saccade
