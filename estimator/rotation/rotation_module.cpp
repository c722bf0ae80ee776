#include "estimator/rotation/rotation_module.h"

#include <fmt/core.h>

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/config/config.h"
#include "core/io/events/event_queue.h"
#include "core/io/trajectory_file.h"
#include "core/process/progress.h"
#include "core/stopwatch.h"
#include "estimator/imu/imu_input.h"
#include "estimator/rotation/rate_fusion.h"
#include "estimator/run/run_input.h"
#include "estimator/run/run_writer.h"
#include "estimator/tracking/gyroscope.h"

namespace saccade {
namespace {

using Method = RotationConfig::Method;
using Rates = std::vector<StampedTwist>;  // without velocity

StampedTwist rate_at(double t_s, const Eigen::Vector3d& rate) {
  return {t_s, Eigen::Vector3d::Zero(), rate};
}

double middle_of(std::span<const Event> window) {
  return seconds_from_ns((window.front().t_ns + window.back().t_ns) / 2);
}

/// As many events as tell next_window_size() whether the window is the last one.
std::size_t events_ahead(const RotationOptions& options) {
  const auto whole = static_cast<std::size_t>(options.window_events);
  return whole + whole / 2 + 1;
}

/// The last window is that which reaches the end.
std::size_t step_of(std::span<const Event> window, std::span<const Event> events) {
  return window.size() == events.size() ? events.size() : window_step(window);
}

/// From events alone, window by window.
Rates rates_of(EventQueue& queue, const PinholeCamera& camera, const RotationOptions& options,
               Progress& progress) {
  Rates rates;
  RotationEstimator estimator(camera, options);
  RotationEstimate last;
  double duration_s = options.min_window_s;
  const std::size_t needed = events_ahead(options);
  for (auto events = queue.ahead(needed); !events.empty(); events = queue.ahead(needed)) {
    std::span<const Event> window;
    RotationEstimate found;
    // A window is as long as its own motion wants it, to a factor of two: once more where the motion
    // was another than before.
    for (int attempt = 0; attempt < 2; ++attempt) {
      const std::size_t before = window.size();
      window = events.first(next_window_size(events, duration_s, options));
      if (window.size() == before) break;
      found = estimator.estimate(window, RotationEstimator::predict(last, middle_of(window)));
      const double used_s = duration_s;
      if (found.is_valid) duration_s = window_duration(camera, found.turning.rate, options);
      if (duration_s < 2 * used_s && used_s < 2 * duration_s) break;
    }
    last = found;
    if (last.is_valid) rates.push_back(rate_at(last.t_s, last.turning.rate));
    const std::size_t done = step_of(window, events);
    queue.drop(done);
    progress.add(done);
  }
  return rates;
}

/// Motion by the gyroscope in the middle of a window. The mean over a window of length T is
/// w + w'' T^2 / 24, that over its inner half w + w'' T^2 / 96; eliminating w'' leaves the variance of
/// a mean over kAveragedFraction of the window.
constexpr double kAveragedFraction = 0.36;
AngularMotion motion_of(const Gyroscope& gyroscope, TimeNs start_ns, TimeNs end_ns) {
  const TimeNs length_ns = end_ns - start_ns, middle_ns = start_ns + length_ns / 2;
  AngularMotion motion;
  motion.rate = (4 * gyroscope.mean_rate(start_ns + length_ns / 4, end_ns - length_ns / 4) -
                 gyroscope.mean_rate(start_ns, end_ns)) /
                3;
  if (length_ns > 0)
    motion.acceleration =
        (gyroscope.mean_rate(middle_ns, end_ns) - gyroscope.mean_rate(start_ns, middle_ns)) /
        seconds_from_ns(length_ns / 2);
  return motion;
}

/// From both, window by window; the search starts at the motion by the gyroscope.
Rates rates_of(EventQueue& queue, const PinholeCamera& camera, const RotationConfig& config,
               const Gyroscope& gyroscope, Progress& progress) {
  Rates rates;
  RotationEstimator estimator(camera, config.events);
  RateFusion fusion(config.gyroscope);
  const std::size_t needed = events_ahead(config.events);
  for (auto events = queue.ahead(needed); !events.empty(); events = queue.ahead(needed)) {
    const AngularMotion now =
        motion_of(gyroscope, events.front().t_ns,
                  events.front().t_ns + ns_from_seconds(config.events.min_window_s));
    const double duration_s = window_duration(camera, now.rate - fusion.bias(), config.events);
    const std::span<const Event> window =
        events.first(next_window_size(events, duration_s, config.events));
    const TimeNs start_ns = window.front().t_ns, end_ns = window.back().t_ns;
    const AngularMotion measured = motion_of(gyroscope, start_ns, end_ns);
    const RotationEstimate found =
        estimator.estimate(window, {measured.rate - fusion.bias(), measured.acceleration});
    const double averaged_s = kAveragedFraction * seconds_from_ns(end_ns - start_ns);
    const double middle_s = middle_of(window);
    // Before the first estimate from events the bias is unknown.
    if (found.is_valid)
      rates.push_back(
          rate_at(middle_s, fusion.fuse({middle_s, averaged_s, found.px_per_rate, measured.rate,
                                         RotationEstimator::predict(found, middle_s).rate})));
    else if (!rates.empty())
      rates.push_back(rate_at(middle_s, fusion.without_events(measured.rate)));
    const std::size_t done = window.size();
    queue.drop(done);
    progress.add(done);
  }
  return rates;
}

/// The gyroscope less the bias that the orientation filter has estimated by then, averaged over
/// `averaging_s`.
Rates rates_of(const ImuInput& imu, const OrientationOptions& options, double averaging_s) {
  Rates rates;
  const auto orientations = estimate_orientations(imu.samples, options);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::size_t begin = 0;
  for (std::size_t i = 0; i < imu.samples.size(); ++i) {
    sum += imu.samples[i].angular_velocity - orientations[i].gyro.bias;
    const TimeNs first_ns = imu.samples[begin].t_ns, t_ns = imu.samples[i].t_ns;
    if (seconds_from_ns(t_ns - first_ns) < averaging_s) continue;
    rates.push_back(rate_at(seconds_from_ns(first_ns + (t_ns - first_ns) / 2),
                            imu.camera_from_imu * sum / static_cast<double>(i - begin + 1)));
    sum.setZero();
    begin = i + 1;
  }
  return rates;
}

/// `events`: none for Method::kImu.
Rates find_rates(const RotationConfig& config, const PinholeCamera& camera, EventQueue* events,
                 const std::optional<ImuInput>& imu, Progress& progress) {
  switch (config.method) {
    case Method::kEvents:
      return rates_of(*events, camera, config.events, progress);
    case Method::kImu:
      return rates_of(*imu, config.orientation, config.averaging_s);
    case Method::kBoth:
      break;
  }
  const Gyroscope gyroscope(imu->samples, imu->camera_from_imu, Eigen::Vector3d::Zero());
  return rates_of(*events, camera, config, gyroscope, progress);
}

/// Rates over a window are stamped with its middle.
MethodClass class_of(const RotationConfig& config) {
  const bool is_averaged = config.method != Method::kImu || config.averaging_s > 0;
  const bool is_smoothed = config.method == Method::kImu &&
                           config.orientation.method == OrientationOptions::Method::kSmoothed;
  MethodClass method{{},
                     is_smoothed   ? Processing::kBatch
                     : is_averaged ? Processing::kFixedLag
                                   : Processing::kCausal};
  if (config.method != Method::kImu) method.inputs.insert(MethodInput::kEvents);
  if (config.method != Method::kEvents) method.inputs.insert(MethodInput::kImu);
  return method;
}

}  // namespace

void describe(config::Fields& fields, RotationConfig& config) {
  using Method = RotationConfig::Method;
  fields.choice("method", config.method,
                {{"events", Method::kEvents}, {"imu", Method::kImu}, {"both", Method::kBoth}},
                "Source of the angular velocity: contrast maximisation over the events "
                "(`events`), the gyroscope less its estimated bias (`imu`), or the fusion of "
                "both by their variances (`both`).");
  if (config.method != Method::kImu) {
    fields.group(
        "window",
        [&](config::Fields& window) {
          window
              .value("events", config.events.window_events,
                     "Number of events per window, about two per pixel of the sensor. Larger "
                     "windows average more noise, but the rotation may change too much within "
                     "them.")
              .range(100, 1e8);
        },
        "Part of the events that gives one angular velocity.");
  }
  if (config.method == Method::kImu) {
    fields.section("orientation", config.orientation,
                   "Orientation filter that estimates the bias of the gyroscope.");
    fields
        .value("averaging_s", config.averaging_s,
               "Time over which the angular velocity is averaged, in seconds. 0 writes every "
               "sample.")
        .range(0, 10);
  }
  if (config.method == Method::kBoth) describe(fields, config.gyroscope);
  fields.value("seed", config.seed,
               "Seed of the run. It changes nothing here: no random numbers are drawn.");
}

RunSummary run_rotation(const RunRequest& request) {
  const auto config = read_config<RotationConfig>(request);
  RunWriter writer(request);

  RunTiming timing;
  const Dataset dataset = Dataset::open(request.dataset);
  std::optional<ImuInput> imu;
  {
    const ScopedTimer clock(timing.io_s);
    if (config.method != Method::kEvents) imu = load_imu_input(dataset, "method: imu or both");
  }
  const bool takes_events = config.method != Method::kImu;
  const TimeWindow event_times = takes_events ? event_window(request, dataset) : TimeWindow();
  Rates rates;
  std::optional<Progress> progress;
  for (int i = 0; i < request.repeat; ++i) {
    std::optional<EventQueue> events;
    std::uint64_t expected = 0;
    if (takes_events) {
      events.emplace(dataset.stream_events(event_times));
      expected = events->expected_count() * static_cast<std::uint64_t>(request.repeat);
      if (events->ahead(1).empty()) refuse_no_events(dataset);
    }
    if (!progress) progress.emplace("rotation", expected, "events");
    const double opened_s = events ? events->waited_s() : 0;
    const Stopwatch working;
    rates = find_rates(config, dataset.camera(), events ? &*events : nullptr, imu, *progress);
    const double reading_s = events ? events->waited_s() : 0;
    timing.wall_s.push_back(working.seconds() - (reading_s - opened_s));
    if (i + 1 == request.repeat) timing.io_s += reading_s;
    timing.events = events ? events->dropped() : 0;
  }
  const double first_s = rates.empty() ? 0 : rates.front().t_s;
  const double last_s = rates.empty() ? 0 : rates.back().t_s;
  timing.sequence_s = last_s - first_s;
  {
    const ScopedTimer clock(timing.io_s);
    write_angular_velocities(writer.path() / "angular_velocity.txt", rates);
  }
  writer.set_class(class_of(config));
  writer.finish("rotation", request, dataset, window_of(request, first_s, last_s), config.seed,
                config::print(config), timing);

  return summary_of(timing, fmt::format("{} angular velocities", rates.size()));
}

}  // namespace saccade
