#include "estimator/imu/turning_events.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/io/events/event_queue.h"
#include "core/time_search.h"
#include "estimator/imu/rest_detector.h"

namespace saccade {
namespace {

/// As long as a rest has to be at least (RestDetector), and long enough that a slow turn shows.
constexpr double kWindow_s = 0.4;
/// A turn that moves the image by less between the ends of a window does not show.
constexpr double kLeastMotion_px = 2;
/// The fastest that a rest may seem to turn: the gate of RestDetector about a bias that it takes for
/// possible.
constexpr double kFastestRest = 0.3;  // [rad/s]
/// With fewer events the two images differ by chance alone.
constexpr std::size_t kLeastEvents = 500;
/// Of the sharpness along over that against the turn. Simulated cameras at rest have 0.99 to 1.01,
/// with a DAVIS240C's noise; ones that turn at 0.03 to 0.12 rad/s beside a bias of 0.09 have 1.2 to
/// 3.1.
constexpr double kSharper = 1.1;
/// A hot pixel would draw a line into both images that drowns all else.
constexpr std::uint8_t kMostPerPixel = 20;
constexpr std::size_t kBatch = std::size_t{1} << 18U;

double contrast(const ImageF& image) {
  double sum = 0, squares = 0;
  for (const float value : image.pixels()) {
    sum += static_cast<double>(value);
    squares += static_cast<double>(value) * static_cast<double>(value);
  }
  return squares - sum * sum / static_cast<double>(image.size());
}

/// Consecutive samples, and what they read in the mean.
struct SampleWindow {
  std::span<ImuSample> samples;
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();

  explicit SampleWindow(std::span<ImuSample> some) : samples(some) {
    for (const ImuSample& sample : some) {
      rate += sample.angular_velocity / static_cast<double>(some.size());
      force += sample.specific_force / static_cast<double>(some.size());
    }
  }
  [[nodiscard]] TimeNs begin_ns() const { return samples.front().t_ns; }
  [[nodiscard]] TimeNs end_ns() const { return samples.back().t_ns; }
  [[nodiscard]] bool might_rest() const {
    return rate.norm() < kFastestRest && std::abs(force.norm() - kGravity_m_s2) < kMaxForceError;
  }
  /// How far the image moves at that rate.
  [[nodiscard]] double motion_px(const PinholeCamera& camera) const {
    const double reach_px = std::max({camera.fx, camera.fy, 0.5 * camera.width});
    return rate.norm() * seconds_from_ns(end_ns() - begin_ns()) * reach_px;
  }
};

/// In order: those in which the sensor might be at rest, or turn so fast that it shows.
std::vector<SampleWindow> windows_in_doubt(std::span<ImuSample> samples,
                                           const PinholeCamera& camera) {
  std::vector<SampleWindow> windows;
  for (std::size_t begin = 0, end = 0; begin < samples.size(); begin = end) {
    const TimeNs until_ns = samples[begin].t_ns + ns_from_seconds(kWindow_s);
    for (end = begin + 1; end < samples.size() && samples[end].t_ns < until_ns;) ++end;
    const SampleWindow window(samples.subspan(begin, end - begin));
    if (window.might_rest() && window.motion_px(camera) >= kLeastMotion_px)
      windows.push_back(window);
  }
  return windows;
}

}  // namespace

TurningEvents::TurningEvents(const PinholeCamera& camera, const Eigen::Vector3d& rate, TimeNs at_ns)
    : camera_(camera.undistorted()),
      undistortion_(camera),
      rate_(rate),
      at_ns_(at_ns),
      fired_(camera.width, camera.height),
      along_(camera.width, camera.height),
      against_(camera.width, camera.height) {}

void TurningEvents::add(std::span<const Event> events) {
  for (const Event& event : events) {
    std::uint8_t& fired = fired_(event.x, event.y);
    if (fired == kMostPerPixel) continue;
    ++fired;
    const Eigen::Vector3d ray = camera_.ray(undistortion_(event.x, event.y).cast<double>());
    // Slow turns over parts of a second: to first order in the angle.
    const Eigen::Vector3d shift = seconds_from_ns(event.t_ns - at_ns_) * rate_.cross(ray);
    const auto draw = [&](const Eigen::Vector3d& moved, ImageF& image) {
      const Eigen::Vector2d pixel = camera_.project(moved);
      if (moved.z() > 0 && is_inside(image, pixel.x(), pixel.y()))
        splat(image, pixel.x(), pixel.y(), 1.0F);
    };
    draw(ray + shift, along_);
    draw(ray - shift, against_);
    ++count_;
  }
}

bool TurningEvents::show_turn() const {
  return count_ >= kLeastEvents && contrast(along_) > kSharper * contrast(against_);
}

void mark_turns(ImuInput& imu, const Dataset& dataset) {
  const std::vector<SampleWindow> windows = windows_in_doubt(imu.samples, dataset.camera());
  if (windows.empty()) return;
  // One pass over the events: not every format finds a time but by reading all before it.
  EventQueue events(dataset.stream_events({windows.front().begin_ns(), windows.back().end_ns()}));
  const auto pass_to = [&](TimeNs until_ns, const auto& use) {
    for (auto ahead = events.ahead(kBatch); !ahead.empty(); ahead = events.ahead(kBatch)) {
      const std::span<const Event> before = ahead.first(count_before(ahead, until_ns));
      use(before);
      events.drop(before.size());
      if (before.size() < ahead.size()) break;
    }
  };
  for (const SampleWindow& window : windows) {
    TurningEvents turning(dataset.camera(), imu.camera_from_imu * window.rate,
                          window.begin_ns() + (window.end_ns() - window.begin_ns()) / 2);
    pass_to(window.begin_ns(), [](std::span<const Event>) {});
    pass_to(window.end_ns(), [&](std::span<const Event> some) { turning.add(some); });
    if (turning.show_turn())
      for (ImuSample& sample : window.samples) sample.may_rest = false;
  }
}

}  // namespace saccade
