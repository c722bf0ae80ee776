#include "estimator/external/external_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>

#include "core/error.h"
#include "core/io/calibration_file.h"
#include "core/io/events/event_file.h"
#include "core/io/files/atomic_file.h"
#include "core/io/imu_file.h"
#include "core/io/trajectory_file.h"
#include "estimator/run/run_input.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// `t,x,y,p` below a line with these names, times in the unit, p 0 or 1.
void write_events_csv(const fs::path& file, std::span<const Event> events, StampUnit unit) {
  const TimeNs ns_per_unit = unit == StampUnit::kNanoseconds ? 1 : 1000;
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "t_{},x,y,p\n", ns_per_unit == 1 ? "ns" : "us");
  for (const Event& event : events)
    fmt::format_to(std::back_inserter(text), "{},{},{},{}\n", event.t_ns / ns_per_unit, event.x,
                   event.y, event.polarity > 0 ? 1 : 0);
  write_atomically(file, {text.data(), text.size()});
}

fs::path write_events(const fs::path& folder, const AdapterConfig& config,
                      const PinholeCamera& camera, std::span<const Event> events) {
  const fs::path file = folder / ("events." + config.events);
  if (config.events == "csv") {
    write_events_csv(file, events, config.event_unit);
    return file;
  }
  const TimestampUnit unit = config.event_unit == StampUnit::kNanoseconds
                                 ? TimestampUnit::kNanoseconds
                                 : TimestampUnit::kMicroseconds;
  const std::unique_ptr<EventWriter> writer =
      make_event_writer(file, unit, {camera.width, camera.height});
  writer->append(events);
  writer->close();
  return file;
}

/// From the first event on where the request leaves it open, to the last one.
RunRecord::Window window_over_events(const RunRequest& request, std::span<const Event> events) {
  return window_of(request, seconds_from_ns(events.front().t_ns),
                   seconds_from_ns(events.back().t_ns));
}

}  // namespace

std::vector<ImuSample> imu_window(const RunRequest& request, const Dataset& dataset,
                                  std::span<const Event> events) {
  if (!dataset.has_imu())
    throw InputError(dataset.folder().string(), "holds no imu.txt, which {imu} asks for");
  const RunRecord::Window window = window_over_events(request, events);
  std::vector<ImuSample> samples = dataset.load_imu();
  std::erase_if(samples, [&](const ImuSample& sample) {
    const double t_s = seconds_from_ns(sample.t_ns);
    return t_s < window.start_s || t_s > window.end_s;
  });
  return samples;
}

Trajectory groundtruth_start(const Dataset& dataset, double from_s, double truth_s) {
  std::vector<StampedPose> start;
  for (const StampedPose& pose : dataset.groundtruth().poses()) {
    if (pose.t_s > from_s + truth_s) break;
    if (pose.t_s <= from_s) start.clear();
    start.push_back(pose);
  }
  if (start.empty())
    throw InputError(dataset.folder().string(),
                     fmt::format("groundtruth.txt holds no pose of the first {:.4g} s, which "
                                 "start.truth_s asks for",
                                 truth_s));
  return Trajectory(std::move(start));
}

ExternalInput write_external_input(const fs::path& folder, const AdapterConfig& config,
                                   const RunRequest& request, const Dataset& dataset,
                                   std::span<const Event> events) {
  fs::create_directories(folder);
  ExternalInput input;
  const double first_s = seconds_from_ns(events.front().t_ns);
  RunRecord::Window& window = input.window;
  window = window_over_events(request, events);
  const PinholeCamera& camera = dataset.camera();
  write_calib_txt(folder / "calib.txt", camera);
  write_camera_yaml(folder / "camera.yaml", camera);
  input.values = {{"input", folder},
                  {"dataset", fs::absolute(dataset.folder()).lexically_normal()},
                  {"events", write_events(folder, config, dataset.camera(), events)},
                  {"calib", folder / "calib.txt"},
                  {"camera", folder / "camera.yaml"},
                  {"start_s", fmt::format("{:.9f}", window.start_s)},
                  {"end_s", fmt::format("{:.9f}", window.end_s)},
                  {"duration_s", fmt::format("{:.9f}", window.end_s - window.start_s)},
                  {"seed", std::to_string(config.seed)},
                  {"threads", std::to_string(request.threads)},
                  {"width", std::to_string(camera.width)},
                  {"height", std::to_string(camera.height)}};
  if (uses_placeholder(command_of(config), "imu")) {
    write_imu(folder / "imu.txt", imu_window(request, dataset, events));
    input.values["imu"] = folder / "imu.txt";
  }
  if (config.truth_s > 0) {
    const Trajectory start = groundtruth_start(dataset, first_s, config.truth_s);
    write_tum_trajectory(folder / "groundtruth.txt", start.poses());
    input.values["groundtruth_start"] = folder / "groundtruth.txt";
    window.start_s = std::max(window.start_s, start.end_s());
  }
  return input;
}

}  // namespace saccade
