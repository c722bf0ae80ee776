#include "simulator/motion/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "core/check.h"
#include "core/error.h"
#include "core/io/trajectory_file.h"
#include "core/random.h"
#include "core/rigid3.h"

namespace saccade {
namespace {

/// A preset in closed form, defined for every time [s], also outside its duration.
struct Preset {
  std::function<Rigid3(double)> world_from_camera;
  double shortest_period_s;  ///< of its fastest part
};

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kNever = std::numeric_limits<double>::infinity();

double shortest_period(const Vector3d& frequency_hz) {
  const double highest = frequency_hz.maxCoeff();
  return highest > 0 ? 1 / highest : kNever;
}

/// The camera's rotation at `position`; throws InputError naming `look_at` or `up` where it is
/// undefined.
Eigen::Quaterniond orientation_at(const PresetOrientation& options, const Vector3d& position) {
  if (!options.look_at) return Eigen::Quaterniond(rotation_of(options.rotation_deg));
  constexpr double kNearlyZero = 1e-6;
  const Vector3d forward = *options.look_at - position;
  if (forward.norm() < kNearlyZero)
    throw InputError("look_at", "the camera itself passes through this point");
  const Vector3d z = forward.normalized();
  const Vector3d across = z.cross(options.up.normalized());
  if (across.norm() < kNearlyZero)
    throw InputError("up", "the camera looks along this direction; another one must be up");
  const Vector3d x = across.normalized();
  Eigen::Matrix3d rotation;
  rotation << x, z.cross(x), z;
  return Eigen::Quaterniond(rotation);
}

Vector3d oscillate(const Oscillation& o, double t) {
  return (o.amplitude.array() *
          (kTurn * t * o.frequency_hz.array() + kDegree * o.phase_deg.array()).sin())
      .matrix();
}

Preset slider(const SliderOptions& o, double duration_s) {
  const Vector3d path = o.distance_m * o.direction.normalized();
  return {[o, path, duration_s](double t) -> Rigid3 {
            double s = t / duration_s;
            if (o.profile == SpeedProfile::kSmooth) {
              s = std::clamp(s, 0.0, 1.0);
              s = s * s * s * (10 + s * (-15 + 6 * s));
            }
            const Vector3d position = o.from + s * path;
            return {orientation_at(o.orientation, position), position};
          },
          duration_s};
}

Preset circle(const CircleOptions& o, double duration_s) {
  const Vector3d normal = o.normal.normalized();
  const Vector3d x = (o.start - o.start.dot(normal) * normal).normalized();
  const Vector3d y = normal.cross(x);
  const double rate = kTurn * o.revolutions / duration_s;
  return {[o, x, y, rate](double t) -> Rigid3 {
            const Vector3d position =
                o.centre + o.radius_m * (std::cos(rate * t) * x + std::sin(rate * t) * y);
            return {orientation_at(o.orientation, position), position};
          },
          o.revolutions == 0 ? kNever : kTurn / std::abs(rate)};
}

Preset lissajous(const LissajousOptions& o) {
  Oscillation rotation = o.rotation;
  rotation.amplitude *= kDegree;
  return {
      [o, rotation](double t) -> Rigid3 {
        const Vector3d position = o.centre + oscillate(o.position, t);
        return {orientation_at(o.orientation, position) * so3_exp(oscillate(rotation, t)),
                position};
      },
      std::min(shortest_period(o.position.frequency_hz), shortest_period(o.rotation.frequency_hz))};
}

Preset shake(const ShakeOptions& o) {
  LissajousOptions sines{
      .centre = o.position, .orientation = o.orientation, .position = {}, .rotation = {}};
  // Frequencies of a hand's tremor, without a common period.
  sines.position = {o.translation_amplitude_m, Vector3d(3.1, 2.3, 1.7), Vector3d::Zero()};
  sines.rotation.amplitude = o.rotation_amplitude_deg;
  // The rate of a sin(w t) is at most a w.
  const Vector3d amplitude = kDegree * o.rotation_amplitude_deg;
  sines.rotation.frequency_hz =
      (amplitude.array() > 0)
          .select(o.peak_rate_rad_s.cwiseQuotient(kTurn * amplitude), Vector3d::Zero());
  return lissajous(sines);
}

/// Sums of sines on six axes: 0..2 position [m], 3..5 rotation vector [rad].
class RandomSines {
 public:
  explicit RandomSines(const RandomMotionOptions& options) {
    const Random random(options.seed);
    const auto [low, high] = options.frequency_hz;
    rms_ << options.position_rms_m, kDegree * options.rotation_rms_deg;
    for (std::size_t axis = 0; axis < 6; ++axis) {
      for (std::size_t k = 0; k < kSines; ++k) {
        rate_[axis][k] = kTurn * (low + (high - low) * random.uniform(axis, 2 * k));
        phase_[axis][k] = kTurn * random.uniform(axis, 2 * k + 1);
      }
    }
  }

  [[nodiscard]] Twist operator()(double t) const {
    Twist value = Twist::Zero();
    for (std::size_t axis = 0; axis < 6; ++axis) {
      for (std::size_t k = 0; k < kSines; ++k) {
        value[static_cast<Eigen::Index>(axis)] += std::sin(rate_[axis][k] * t + phase_[axis][k]);
      }
    }
    return value.cwiseProduct(rms_) * std::sqrt(2.0 / kSines);
  }

 private:
  static constexpr std::size_t kSines = 8;
  using Table = std::array<std::array<double, kSines>, 6>;
  Twist rms_;
  Table rate_{};
  Table phase_{};
};

Preset random_motion(const RandomMotionOptions& o) {
  const RandomSines sines(o);
  return {[o, sines](double t) -> Rigid3 {
            const Twist offset = sines(t);
            const Vector3d position = o.position + offset.head<3>();
            return {orientation_at(o.orientation, position) * so3_exp(offset.tail<3>()), position};
          },
          1 / o.frequency_hz[1]};
}

/// The closed form behind a preset source. Throws InputError where a view direction is undefined.
Preset make_preset(const MotionOptions& options) {
  switch (options.source) {
    case MotionSource::kSlider:
      return slider(options.slider, options.duration_s);
    case MotionSource::kCircle:
      return circle(options.circle, options.duration_s);
    case MotionSource::kLissajous:
      return lissajous(options.lissajous);
    case MotionSource::kShake:
      return shake(options.shake);
    default:
      SACCADE_CHECK(options.source == MotionSource::kRandom6Dof);
      return random_motion(options.random);
  }
}

/// tx ty tz qx qy qz qw.
Rigid3 pose_from(std::span<const double> numbers) {
  const Eigen::Map<const Eigen::Vector3d> t(&numbers[0]);
  const Eigen::Map<const Eigen::Vector4d> q(&numbers[3]);
  return {Eigen::Quaterniond(q[3], q[0], q[1], q[2]), t};
}

/// world from trajectory, with its scale.
Rigid3 placed(const TransformOptions& transform, const Rigid3& pose) {
  const Eigen::Quaterniond rotation(rotation_of(transform.rotation_deg));
  return {rotation * pose.rotation(),
          rotation * (transform.scale.x() * pose.translation()) + transform.translation};
}

std::vector<StampedPose> waypoint_poses(const MotionOptions& options) {
  std::vector<StampedPose> poses;
  for (const std::vector<double>& w : options.waypoints)
    poses.push_back({w[0], pose_from(std::span(w).subspan(1))});
  if (!poses.empty()) return poses;
  for (const ViewOptions& view : options.views)
    poses.push_back({view.t_s, {orientation_at(view.orientation, view.position), view.position}});
  return poses;
}

/// After `rest_s` at the first of them.
std::vector<StampedPose> file_poses(const std::filesystem::path& file, double rest_s) {
  constexpr double kRestStep_s = 0.01;
  const Trajectory trajectory = read_trajectory(file);
  if (trajectory.size() < 2)
    throw InputError(file.string(), "holds one pose; a motion needs at least two");
  std::vector<StampedPose> poses;
  const StampedPose& first = trajectory.poses().front();
  const auto steps = static_cast<int>(std::ceil(rest_s / kRestStep_s));
  for (int i = 0; i < steps; ++i)
    poses.push_back({first.t_s + rest_s * i / steps, first.world_from_camera});
  for (const StampedPose& pose : trajectory.poses())
    poses.push_back({pose.t_s + rest_s, pose.world_from_camera});
  return poses;
}

Spline fitted(const MotionOptions& options, std::vector<StampedPose> poses,
              const std::string& location) {
  for (StampedPose& p : poses) {
    p.world_from_camera = placed(options.transform, p.world_from_camera);
  }
  try {
    return options.fit == Fit::kSmooth ? Spline::smooth(poses, options.knot_spacing_s)
                                       : Spline::interpolate(poses);
  } catch (const InputError& error) {
    throw InputError(location, error.what());
  }
}

Spline controlled(const MotionOptions& options) {
  const auto& rows = options.control_poses;
  const bool timed = rows.front().size() == 8;
  std::vector<Rigid3> poses;
  for (const std::vector<double>& row : rows) {
    const Rigid3 pose = pose_from(std::span(row).subspan(timed ? 1 : 0));
    poses.push_back(placed(options.transform, pose));
  }
  if (!timed) return Spline::from_control_poses(poses, 0, options.knot_spacing_s);
  const double spacing = (rows.back()[0] - rows.front()[0]) / static_cast<double>(rows.size() - 1);
  return Spline::from_control_poses(poses, rows.front()[0] + spacing, spacing);
}

/// Samples beyond both ends keep the natural ends' lack of acceleration out of the motion: their
/// influence falls by 3.7 per sample.
Spline sampled(const MotionOptions& options) {
  constexpr double kSamplesPerPeriod = 100;
  constexpr double kLongestStep = 0.01;
  constexpr int kBeyond = 16;
  const Preset preset = make_preset(options);
  const double wanted = std::min(
      {kLongestStep, preset.shortest_period_s / kSamplesPerPeriod, options.duration_s / 10});
  const int steps = static_cast<int>(std::ceil(options.duration_s / wanted));
  const double step = options.duration_s / steps;
  std::vector<StampedPose> poses;
  for (int i = -kBeyond; i <= steps + kBeyond; ++i) {
    const Rigid3 pose = preset.world_from_camera(i * step);
    poses.push_back({i * step, placed(options.transform, pose)});
  }
  return Spline::interpolate(poses).cut(0, options.duration_s);
}

}  // namespace

Spline build_motion(const MotionOptions& options, const std::string& name) {
  switch (options.source) {
    case MotionSource::kControlPoses:
      return controlled(options);
    case MotionSource::kWaypoints:
      return fitted(options, waypoint_poses(options), name + ".waypoints");
    case MotionSource::kFile:
      return fitted(options, file_poses(options.file, options.rest_s), options.file.string());
    default:
      return sampled(options);
  }
}

Spline cut_motion(const Spline& motion, double start_s, std::optional<double> duration_s) {
  // Spans are often written with a few decimals; what is beyond the end by less than this is the
  // end.
  constexpr double kTolerance = 1e-6;
  const double span = motion.end_s() - motion.start_s();
  if (!(start_s >= 0 && start_s < span))
    throw InputError(
        "start_s",
        fmt::format("{} s lies outside the trajectory, which lasts {:.9g} s", start_s, span));
  const double rest = span - start_s;
  const double duration = duration_s.value_or(rest);
  if (!(duration > 0))
    throw InputError("duration_s", fmt::format("must be above 0; it is {} s", duration));
  if (duration > rest + kTolerance)
    throw InputError("duration_s",
                     fmt::format("{} s from {} s on is more than the trajectory, which "
                                 "lasts {:.9g} s",
                                 duration, start_s, span));
  return motion.cut(motion.start_s() + start_s, std::min(duration, rest));
}

}  // namespace saccade
