#include "eval/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "core/error.h"
#include "core/io/dataset.h"
#include "core/io/dataset_record.h"
#include "core/io/event_file.h"
#include "eval/evaluate.h"
#include "eval/run_folder.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr TimeNs kRateWindowNs = 1'000'000;

/// Largest number of events within one millisecond, as a rate [1/s].
double peak_rate(const Events& events) {
  std::size_t most = 0;
  std::size_t begin = 0;
  for (std::size_t end = 0; end < events.size(); ++end) {
    while (events[end].t_ns - events[begin].t_ns >= kRateWindowNs) ++begin;
    most = std::max(most, end + 1 - begin);
  }
  return static_cast<double>(most) / seconds_from_ns(kRateWindowNs);
}

std::string describe_events(const Events& events) {
  if (events.empty()) return "  events      none\n";
  const auto on =
      std::count_if(events.begin(), events.end(), [](const Event& e) { return e.polarity > 0; });
  const double first_s = seconds_from_ns(events.front().t_ns);
  const double last_s = seconds_from_ns(events.back().t_ns);
  const auto count = static_cast<double>(events.size());
  std::string text =
      fmt::format("  events      {} ({:.1f} % ON), {:.6f} to {:.6f} s\n", events.size(),
                  100 * static_cast<double>(on) / count, first_s, last_s);
  if (last_s > first_s)
    text += fmt::format("  rate        {:.3f} M/s, at most {:.3f} M/s over 1 ms\n",
                        1e-6 * count / (last_s - first_s), 1e-6 * peak_rate(events));
  return text;
}

std::string describe_camera(const PinholeCamera& camera) {
  const auto& k = camera.distortion;
  std::string text =
      fmt::format("  sensor      {} x {} px, fx {:.6g} fy {:.6g} cx {:.6g} cy {:.6g}\n",
                  camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy);
  if (camera.is_distorted())
    text += fmt::format("  distortion  k1 {:.6g} k2 {:.6g} p1 {:.6g} p2 {:.6g} k3 {:.6g}\n", k[0],
                        k[1], k[2], k[3], k[4]);
  return text;
}

std::string describe_poses(const std::string& label, const Trajectory& trajectory) {
  if (trajectory.empty()) return fmt::format("  {:<11} none\n", label);
  return fmt::format("  {:<11} {} poses, {:.6f} to {:.6f} s, path {:.4g} m\n", label,
                     trajectory.size(), trajectory.start_s(), trajectory.end_s(),
                     trajectory.path_length());
}

std::string describe_files(const std::string& label, const std::vector<StampedFile>& files) {
  if (files.empty()) return {};
  const auto there = std::count_if(files.begin(), files.end(),
                                   [](const StampedFile& f) { return fs::exists(f.file); });
  std::string text = fmt::format("  {:<11} {}, {:.6f} to {:.6f} s", label, files.size(),
                                 files.front().t_s, files.back().t_s);
  if (there != static_cast<std::ptrdiff_t>(files.size()))
    text += fmt::format(", only {} of them there", there);
  return text + "\n";
}

std::string describe_record(const DatasetRecord& record) {
  std::string text;
  if (record.contrast_on && record.contrast_off)
    text += fmt::format("  contrast    ON {:.4g}, OFF {:.4g}, eps {:.4g}\n", *record.contrast_on,
                        *record.contrast_off, record.log_eps);
  if (record.mean_scene_depth_m)
    text += fmt::format("  depth       {:.4g} m on average\n", *record.mean_scene_depth_m);
  if (record.rays && record.rays_per_event)
    text +=
        fmt::format("  rays        {} ({:.3g} per event)\n", *record.rays, *record.rays_per_event);
  if (!record.tool_version.empty())
    text += fmt::format("  written by  saccade {}, seed {}\n", record.tool_version, record.seed);
  return text;
}

PathDescription describe_dataset(const fs::path& folder, bool verify) {
  const Dataset dataset = Dataset::open(folder);
  PathDescription description;
  std::string& text = description.text;
  text = fmt::format("{}: dataset\n", folder.string()) + describe_camera(dataset.camera());
  text += dataset.events_file().empty() ? "  events      none\n"
                                        : describe_events(dataset.load_events());
  text += describe_poses("truth", dataset.groundtruth());
  text += describe_files("frames", dataset.frames());
  text += describe_files("depth maps", dataset.depth_maps());
  text += describe_files("flow maps", dataset.flow_maps());
  if (dataset.has_imu())
    text += fmt::format("  imu         {} samples\n", dataset.load_imu().size());
  if (dataset.record()) text += describe_record(*dataset.record());
  if (!verify) return description;
  description.problems = verify_hashes(folder);
  if (description.problems.empty()) text += "  hashes      all files match dataset.yaml\n";
  return description;
}

PathDescription describe_run(const fs::path& folder, bool verify) {
  if (verify) throw InputError(folder.string(), "a run has no hashes; --verify is for datasets");
  const RunFolder run = RunFolder::open(folder);
  const RunRecord& record = run.record;
  std::string text = fmt::format("{}: run of {}\n", folder.string(), record.module);
  text += fmt::format("  dataset     {}\n", record.dataset.string());
  if (record.window)
    text += fmt::format("  window      {:.6f} to {:.6f} s\n", record.window->start_s,
                        record.window->end_s);
  if (run.trajectory) text += describe_poses("estimate", *run.trajectory);
  text += fmt::format("  written by  saccade {}, seed {}, {} threads\n", record.tool_version,
                      record.seed, record.threads);
  if (!record.command.empty()) text += fmt::format("  command     {}\n", record.command);
  text += run.metrics.empty() ? "  not scored yet: saccade eval " + folder.string() + "\n"
                              : format_metrics(run.metrics, "scores");
  return {text + "configuration:\n" + record.config_yaml, {}};
}

}  // namespace

PathDescription describe_path(const fs::path& path, bool verify) {
  if (!fs::exists(path)) throw InputError(path.string(), "no such file or folder");
  if (fs::is_directory(path))
    return fs::exists(path / "run.yaml") ? describe_run(path, verify)
                                         : describe_dataset(path, verify);
  if (verify) throw InputError(path.string(), "a file has no hashes; --verify is for datasets");
  return {fmt::format("{}: events\n", path.string()) + describe_events(read_events(path, {})), {}};
}

}  // namespace saccade
