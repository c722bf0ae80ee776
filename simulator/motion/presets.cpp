#include "simulator/motion/presets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/check.h"
#include "core/error.h"
#include "core/random.h"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kNever = std::numeric_limits<double>::infinity();

double shortest_period(const Vector3d& frequency_hz) {
  const double highest = frequency_hz.maxCoeff();
  return highest > 0 ? 1 / highest : kNever;
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

}  // namespace

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

}  // namespace saccade
