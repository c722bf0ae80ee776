#include "eval/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>

#include "core/error.h"
#include "core/io/dataset/dataset.h"
#include "core/io/events/event_file.h"
#include "core/io/events/event_formats.h"
#include "eval/evaluate.h"
#include "eval/picture/view/sensor_view.h"
#include "eval/run_folder.h"
#include "eval/table/number_text.h"

namespace saccade {
namespace fs = std::filesystem;
namespace {

std::string line(const std::string& label, const std::string& text) {
  return fmt::format("  {:<13}{}\n", label, text);
}

constexpr TimeNs kRateBinNs = 10'000'000;

/// What is said of a stream of events, gathered block by block.
struct EventSummary {
  std::uint64_t count = 0;
  std::uint64_t on = 0;
  TimeNs first_ns = 0;
  TimeNs last_ns = 0;
  int columns = 0;  ///< of the smallest sensor that holds them [px]
  int rows = 0;
  std::uint64_t most_in_bin = 0;  ///< of the consecutive kRateBinNs from the first event on

  void add(const Event& event) {
    if (count++ == 0) first_ns = event.t_ns;
    last_ns = event.t_ns;
    if (event.polarity > 0) ++on;
    columns = std::max(columns, event.x + 1);
    rows = std::max(rows, event.y + 1);
    if (event.t_ns - first_ns >= bin_end_ns_) {
      bin_end_ns_ = ((event.t_ns - first_ns) / kRateBinNs + 1) * kRateBinNs;
      in_bin_ = 0;
    }
    most_in_bin = std::max(most_in_bin, ++in_bin_);
  }

 private:
  TimeNs bin_end_ns_ = kRateBinNs;  ///< after the first event
  std::uint64_t in_bin_ = 0;
};

EventSummary summarise(EventStream& stream) {
  EventSummary summary;
  for (auto events = stream.next(); !events.empty(); events = stream.next())
    for (const Event& event : events) summary.add(event);
  return summary;
}

std::string event_lines(const EventSummary& events, TimestampUnit unit) {
  if (events.count == 0) return line("events", "none");
  const auto on = static_cast<double>(events.on);
  const auto all = static_cast<double>(events.count);
  const double first_s = seconds_from_ns(events.first_ns);
  const double last_s = seconds_from_ns(events.last_ns);
  const double peak_rate = static_cast<double>(events.most_in_bin) / seconds_from_ns(kRateBinNs);
  std::string text = line("events", fmt::format("{} ({} ON, {} OFF: {:.1f} % ON)", grouped(all),
                                                grouped(on), grouped(all - on), 100 * on / all)) +
                     line("time", fmt::format("{:.6f} .. {:.6f} s ({:.6f} s), stamps in {}",
                                              first_s, last_s, last_s - first_s,
                                              unit == TimestampUnit::kNanoseconds ? "ns" : "us"));
  if (last_s > first_s)
    text += line("rate", fmt::format("{} events/s mean, {} events/s in the busiest 10 ms",
                                     grouped(all / (last_s - first_s)), grouped(peak_rate)));
  return text;
}

std::string camera_lines(const PinholeCamera& camera) {
  std::string text = line(
      "sensor", fmt::format("{} x {} px, fx {:.2f} fy {:.2f} cx {:.2f} cy {:.2f} px", camera.width,
                            camera.height, camera.fx, camera.fy, camera.cx, camera.cy));
  const auto& d = camera.distortion;
  return text +
         line("distortion", camera.is_distorted()
                                ? fmt::format("k1 {:.4g} k2 {:.4g} p1 {:.4g} p2 {:.4g} k3 {:.4g}",
                                              d[0], d[1], d[2], d[3], d[4])
                                : "none");
}

/// "87, 0.000 .. 3.334 s, 25.8 Hz".
std::string stamped_text(std::size_t count, double start_s, double end_s) {
  if (count == 0) return "none";
  std::string text =
      fmt::format("{}, {:.3f} .. {:.3f} s", grouped(static_cast<double>(count)), start_s, end_s);
  if (count > 1 && end_s > start_s)
    text += fmt::format(", {} Hz", significant(static_cast<double>(count - 1) / (end_s - start_s)));
  return text;
}

std::string files_text(const std::vector<StampedFile>& files) {
  return files.empty() ? "none" : stamped_text(files.size(), files.front().t_s, files.back().t_s);
}

std::string poses_text(const Trajectory& poses) {
  return poses.empty() ? "none" : stamped_text(poses.size(), poses.start_s(), poses.end_s());
}

std::string groundtruth_text(const Trajectory& truth) {
  if (truth.empty()) return "none";
  return poses_text(truth) + fmt::format(", path {} m", significant(truth.path_length()));
}

std::string imu_text(const Dataset& dataset) {
  if (!dataset.has_imu()) return "none";
  const std::vector<ImuSample> samples = dataset.load_imu();
  if (samples.empty()) return "none";
  return stamped_text(samples.size(), seconds_from_ns(samples.front().t_ns),
                      seconds_from_ns(samples.back().t_ns));
}

/// "1,204 signal, 3 leak".
std::string labels_text(const Dataset& dataset) {
  if (!dataset.has_labels()) return "none";
  constexpr std::array<const char*, 4> kOrigins{"signal", "leak", "shot noise", "hot pixel"};
  std::array<std::size_t, 4> counts{};
  for (const std::uint8_t origin : dataset.load_labels().origin)
    if (origin < counts.size()) ++counts[origin];
  std::string text;
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] > 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ",
                          grouped(static_cast<double>(counts[i])), kOrigins[i]);
  return text.empty() ? "of no events" : text;
}

std::string record_lines(const Dataset& dataset) {
  const DatasetFacts& facts = dataset.facts();
  std::string text;
  if (facts.mean_depth_m) text += line("mean depth", significant(facts.mean_depth_m, 4) + " m");
  if (facts.contrast_on && facts.contrast_off)
    text += line("contrast", fmt::format("ON {} OFF {}", *facts.contrast_on, *facts.contrast_off));
  if (!dataset.record()) return text;
  const DatasetRecord& record = *dataset.record();
  text += line("seed", std::to_string(record.seed));
  if (record.rays_per_event)
    text += line("rays", fmt::format("{} per event", significant(record.rays_per_event)));
  if (!record.tool_version.empty()) text += line("written by", record.tool_version);
  return text;
}

std::string describe_dataset(const fs::path& folder) {
  const Dataset dataset = Dataset::open(folder);
  std::string text = fmt::format("dataset {} ({})\n", dataset.facts().name, folder.string());
  text += camera_lines(dataset.camera());
  if (dataset.events_file().empty()) {
    text += line("events", "none");
  } else {
    EventStream stream(dataset.events_file(), {dataset.camera().width, dataset.camera().height});
    text += event_lines(summarise(stream), stream.unit());
  }
  text += line("poses", groundtruth_text(dataset.groundtruth()));
  text += line("frames", files_text(dataset.frames()));
  text += line("depth maps", files_text(dataset.depth_maps()));
  text += line("IMU", imu_text(dataset));
  text += line("event labels", labels_text(dataset));
  if (const std::size_t further = dataset.further_cameras().size(); further > 0)
    text += line("rig", fmt::format("{} cameras, this one and {} below it", further + 1, further));
  return text + record_lines(dataset);
}

std::string indented(const std::string& text) {
  std::string result;
  std::istringstream lines(text);
  for (std::string one; std::getline(lines, one);) result += "  " + one + "\n";
  return result;
}

std::string describe_run(const fs::path& folder) {
  const RunFolder run = RunFolder::open(folder);
  const RunRecord& r = run.record;
  std::string text = fmt::format("run {} ({})\n", run.name(), folder.string());
  text += line("module", r.module);
  text += line("dataset",
               r.dataset.string() + (fs::is_directory(r.dataset) ? "" : " (not there any more)"));
  if (r.window)
    text += line("window", fmt::format("{:.6f} .. {:.6f} s", r.window->start_s, r.window->end_s));
  text += line("seed", std::to_string(r.seed));
  if (r.threads > 0) text += line("threads", std::to_string(r.threads));
  if (!r.command.empty()) text += line("command", r.command);
  if (!r.tool_version.empty()) text += line("written by", r.tool_version);
  if (!r.machine.empty()) text += line("machine", r.machine);
  if (run.trajectory) text += line("poses", poses_text(*run.trajectory));
  if (run.poses)
    text += line("lost poses",
                 fmt::format("{}, by their own report",
                             std::count_if(run.poses->begin(), run.poses->end(),
                                           [](const PoseRow& p) { return p.status == "lost"; })));
  if (!run.metrics.empty())
    text += format_metrics(run.metrics, "scores");
  else
    text += line("scores", "none yet; `saccade eval` writes them");
  if (!r.config_yaml.empty()) text += "configuration\n" + indented(r.config_yaml);
  return text;
}

std::string describe_event_file(const fs::path& file) {
  EventStream stream(file);
  const EventSummary events = summarise(stream);
  std::string text = fmt::format("event file {}\n", file.string());
  text += line("format", std::string(recognise_event_format(file).name));
  text += event_lines(events, stream.unit());
  const SensorSize sensor = stream.sensor();
  return text + line("sensor", sensor.width > 0
                                   ? fmt::format("{} x {} px", sensor.width, sensor.height)
                                   : fmt::format("not stated, at least {} x {} px", events.columns,
                                                 events.rows));
}

}  // namespace

PathDescription describe_path(const fs::path& path, bool verify) {
  if (!fs::exists(event_file_place(path).file)) throw InputError(path.string(), "is not there");
  if (!fs::is_directory(path)) {
    if (verify) throw InputError(path.string(), "only a dataset folder states hashes to verify");
    return {describe_event_file(path), {}};
  }
  if (fs::exists(path / "run.yaml")) {
    if (verify) throw InputError(path.string(), "a run folder states no hashes to verify");
    return {describe_run(path), {}};
  }
  PathDescription description{describe_dataset(path), {}};
  if (!verify) return description;
  if (!fs::exists(path / "dataset.yaml"))
    throw InputError(path.string(), "has no dataset.yaml, which states the hashes to verify");
  description.problems = verify_hashes(path);
  if (description.problems.empty()) description.text += line("hashes", "all files match");
  return description;
}

}  // namespace saccade
