#include "apps/replica_source.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "core/config/document.h"
#include "core/error.h"
#include "core/io/dataset/dataset.h"
#include "core/io/files/scratch_folder.h"
#include "core/io/images/image_file.h"
#include "core/io/trajectory_file.h"
#include "core/median.h"
#include "core/srgb.h"
#include "estimator/registry.h"

namespace saccade {
namespace fs = std::filesystem;
namespace {

using MotionSourceOption = ReplicaOptions::Motion;

constexpr double kLeastComparable = 0.4;
constexpr double kShortestStretch_s = 0.01;
/// Time in which most pixels of a moving camera have fired once [s].
constexpr double kWarmUp_s = 0.06;
/// Positions that differ by less are those of a rotation [m].
constexpr double kStillPath_m = 1e-3;

struct RecordedMotion {
  Trajectory world_from_camera;
  bool is_recorded = false;  ///< poses of a motion capture, say
  std::string origin;
};

bool is_simulated(const Dataset& dataset) {
  return dataset.record() && !dataset.record()->config_yaml.empty();
}

/// Orientations from angular velocities, linear between them and constant beyond.
Trajectory integrated(const std::vector<StampedTwist>& rates, double start_s, double end_s) {
  constexpr double kStep_s = 1e-3;
  const auto rate_at = [&](double t_s) -> Eigen::Vector3d {
    const auto next = std::ranges::find_if(rates, [&](const auto& r) { return r.t_s > t_s; });
    if (next == rates.begin()) return rates.front().angular_velocity;
    if (next == rates.end()) return rates.back().angular_velocity;
    const auto& before = *std::prev(next);
    const double fraction = (t_s - before.t_s) / (next->t_s - before.t_s);
    return before.angular_velocity + fraction * (next->angular_velocity - before.angular_velocity);
  };
  const int steps = std::max(1, static_cast<int>(std::ceil((end_s - start_s) / kStep_s)));
  std::vector<StampedPose> poses{{start_s, Rigid3()}};
  for (int k = 1; k <= steps; ++k) {
    const double t_s = start_s + (end_s - start_s) * k / steps;
    const double dt_s = t_s - poses.back().t_s;
    const Eigen::Vector3d rate = rate_at(0.5 * (t_s + poses.back().t_s));
    const Eigen::Quaterniond rotation =
        poses.back().world_from_camera.rotation() * so3_exp(dt_s * rate);
    poses.push_back({t_s, Rigid3(rotation, Eigen::Vector3d::Zero())});
  }
  return Trajectory(std::move(poses));
}

/// By the module `rotation`, whose method is "imu" or "events".
RecordedMotion motion_by_rotation(const fs::path& recording, const RecordingPart& part,
                                  const std::string& method, double start_s, double end_s) {
  const ScratchFolder scratch;
  RunRequest request;
  request.dataset = recording;
  request.output = scratch.path() / "rotation";
  request.start_s = part.start_s;
  request.duration_s = part.duration_s;
  const std::vector<std::string> overrides{"method=" + method};
  request.config = config::Document::empty(overrides);
  run_module("rotation", request);
  const auto rates = read_angular_velocities(request.output / "angular_velocity.txt");
  if (rates.empty())
    throw InputError(recording.string(), "its events show no rotation; state --motion poses");
  return {integrated(rates, start_s, end_s), false, "rotation by " + method};
}

RecordedMotion motion_of(const Dataset& dataset, const ReplicaOptions& options, double start_s,
                         double end_s) {
  constexpr double kSlack_s = 0.02;
  const Trajectory& poses = dataset.groundtruth();
  const bool has_poses = !poses.empty() && poses.size() >= 2 &&
                         poses.start_s() < start_s + kSlack_s && poses.end_s() > end_s - kSlack_s;
  MotionSourceOption source = options.motion;
  if (source == MotionSourceOption::kAuto)
    source = has_poses           ? MotionSourceOption::kPoses
             : dataset.has_imu() ? MotionSourceOption::kImu
                                 : MotionSourceOption::kEvents;
  if (source == MotionSourceOption::kPoses) {
    if (!has_poses)
      throw InputError(dataset.folder().string(),
                       "has no poses over the part; state --motion imu or --motion events");
    return {poses, !is_simulated(dataset), "poses"};
  }
  return motion_by_rotation(dataset.folder(), options.part,
                            source == MotionSourceOption::kImu ? "imu" : "events", start_s, end_s);
}

/// Linear radiance as the frame's PNG holds it: a recorded camera's codes are linear in the light.
ImageF frame_radiance(const Dataset& dataset, std::size_t index, ReplicaOptions::Tone tone) {
  const bool is_srgb = tone == ReplicaOptions::Tone::kSrgb ||
                       (tone == ReplicaOptions::Tone::kAuto && is_simulated(dataset));
  ImageF radiance = dataset.load_frame(index);
  if (is_srgb) return radiance;
  for (float& value : radiance.pixels()) value = static_cast<float>(srgb_from_linear(value));
  return radiance;
}

std::optional<double> depth_at(const Dataset& dataset, double t_s) {
  const auto& maps = dataset.depth_maps();
  if (maps.empty()) return std::nullopt;
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < maps.size(); ++i)
    if (std::abs(maps[i].t_s - t_s) < std::abs(maps[nearest].t_s - t_s)) nearest = i;
  const ImageF map = dataset.load_depth(nearest);
  std::vector<double> valid;
  for (const float z : map.pixels())
    if (z > 0 && std::isfinite(z)) valid.push_back(z);
  if (valid.empty()) return std::nullopt;
  return median(valid);
}

double comparable_fraction(const ImageU8& pixels) {
  const auto seen = std::ranges::count_if(pixels.pixels(), [](std::uint8_t p) { return p != 0; });
  return static_cast<double>(seen) / static_cast<double>(pixels.size());
}

/// The events of the stretch at the pixels that can be compared, times from its begin.
Events events_of(const ReplicaStretch& stretch, std::span<const Event> events) {
  const TimeNs start_ns = ns_from_seconds(stretch.source.start_s);
  const TimeNs end_ns = start_ns + ns_from_seconds(stretch.source.duration_s);
  Events part;
  for (Event event : events) {
    if (event.t_ns < start_ns || event.t_ns >= end_ns) continue;
    if (stretch.comparable(event.x, event.y) == 0) continue;
    event.t_ns -= start_ns;
    part.push_back(event);
  }
  return part;
}

/// A simulated recording begins before a scene at rest, a recorded one in the middle of its motion.
double warm_up_s(const Dataset& dataset, const ReplicaSource& source) {
  if (!is_simulated(dataset)) return kWarmUp_s;
  return std::clamp(source.start_s - source.motion.start_s(), 0.0, kWarmUp_s);
}

/// Indices of at most `count` frames, evenly spaced over [start, end].
std::vector<std::size_t> chosen_frames(const std::vector<StampedFile>& frames, double start_s,
                                       double end_s, int count) {
  std::vector<std::size_t> chosen;
  for (int k = 0; k < count; ++k) {
    const double t_s = start_s + (end_s - start_s) * (k + 0.5) / count;
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < frames.size(); ++i)
      if (std::abs(frames[i].t_s - t_s) < std::abs(frames[nearest].t_s - t_s)) nearest = i;
    if (chosen.empty() || chosen.back() != nearest) chosen.push_back(nearest);
  }
  return chosen;
}

/// Sets the stretch around the frame's time, as long as the view allows; false where none is.
bool set_part(ReplicaStretch& stretch, double frame_s, double longest_s, double start_s,
              double end_s) {
  for (double length_s = std::min(longest_s, end_s - start_s);
       length_s >= std::min(kShortestStretch_s, end_s - start_s); length_s /= 1.5) {
    const double begin_s = std::clamp(frame_s - 0.5 * length_s, start_s, end_s - length_s);
    stretch.source.start_s = begin_s;
    stretch.source.duration_s = length_s;
    stretch.comparable = comparable_pixels(stretch.source);
    if (comparable_fraction(stretch.comparable) >= kLeastComparable) return true;
  }
  return false;
}

}  // namespace

std::vector<ReplicaStretch> replica_stretches(const fs::path& path, const ReplicaOptions& options,
                                              std::vector<std::string>& remarks) {
  if (!fs::is_directory(path)) {
    remarks.push_back("an event file holds no frames: nothing is simulated again");
    return {};
  }
  const Dataset dataset = Dataset::open(path);
  if (dataset.frames().empty()) {
    remarks.push_back("the recording holds no frames: nothing is simulated again");
    return {};
  }
  const EventRecording recording = read_recording(path, options.part);
  const Events& events = recording.events;
  if (events.size() < 2) throw InputError(path.string(), "holds no two events in this part");
  const double start_s = seconds_from_ns(events.front().t_ns);
  const double end_s = seconds_from_ns(events.back().t_ns);
  const RecordedMotion motion = motion_of(dataset, options, start_s, end_s);
  std::vector<ReplicaStretch> stretches;
  const int most = std::max(
      1, std::min(options.stretches, static_cast<int>((end_s - start_s) / options.stretch_s)));
  for (const std::size_t index : chosen_frames(dataset.frames(), start_s, end_s, most)) {
    const double frame_s = dataset.frames()[index].t_s;
    const std::optional<double> depth_m =
        options.depth_m ? options.depth_m : depth_at(dataset, frame_s);
    if (!depth_m && motion.world_from_camera.path_length() > kStillPath_m) {
      remarks.push_back("the camera translates at unknown depth: state --depth-m");
      return {};
    }
    ReplicaStretch stretch;
    stretch.name = fmt::format("{} at {:.3f} s", recording.name, frame_s);
    ReplicaSource& source = stretch.source;
    source.radiance = frame_radiance(dataset, index, options.tone);
    source.noise = is_simulated(dataset) ? 0 : frame_noise(source.radiance);
    source.camera = dataset.camera();
    source.world_from_frame = motion.world_from_camera.at_clamped(frame_s);
    source.depth_m = depth_m.value_or(1);
    source.motion = motion.world_from_camera;
    source.smooths_motion = motion.is_recorded;
    source.log_eps =
        options.log_eps.value_or(is_simulated(dataset) ? dataset.facts().log_eps : kRecordedLogEps);
    if (!set_part(stretch, frame_s, options.stretch_s, start_s, end_s)) {
      remarks.push_back(stretch.name + ": the view leaves the frame at once");
      continue;
    }
    source.warm_up_s = warm_up_s(dataset, source);
    stretch.events = events_of(stretch, events);
    stretches.push_back(std::move(stretch));
  }
  return stretches;
}

}  // namespace saccade
