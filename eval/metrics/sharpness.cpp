#include "eval/metrics/sharpness.h"

#include <cstddef>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/io/events/event_file.h"
#include "core/process/parallel.h"
#include "core/time_search.h"

namespace saccade {
namespace {

void draw(ImageF& image, const Eigen::Vector2d& pixel) {
  if (is_inside(image, pixel.x(), pixel.y())) splat(image, pixel.x(), pixel.y(), 1.0F);
}

}  // namespace

StabilizedRun load_stabilized(const std::filesystem::path& folder) {
  StabilizedRun run;
  run.events = read_events(folder / "events.h5", {});
  run.coordinates = read_stabilized_coordinates(folder / "places.h5", run.events.size());
  run.windows = read_stabilized_windows(folder / "windows.csv");
  return run;
}

WindowImages images_of(const StabilizedRun& run, std::size_t index, const Dataset& dataset) {
  const PinholeCamera camera = dataset.camera().undistorted();
  const UndistortionTable undistorted(dataset.camera());
  const StabilizedWindow& window = run.windows[index];
  const Trajectory& truth = dataset.groundtruth();
  const bool has_truth = !truth.empty();
  WindowImages images;
  images.raw = images.stabilized = ImageF(camera.width, camera.height);
  if (has_truth) images.truth = images.raw;
  Eigen::Quaterniond steady_from_world;
  if (has_truth)
    steady_from_world =
        window.steady_from_camera * truth.at_clamped(window.at_s).rotation().conjugate();
  const std::size_t begin = count_before(run.events, ns_from_seconds(window.start_s));
  const std::size_t end = count_before(run.events, ns_from_seconds(window.end_s));
  for (std::size_t i = begin; i < end; ++i) {
    const Eigen::Vector2d from =
        undistorted(run.coordinates.source_x[i], run.coordinates.source_y[i]).cast<double>();
    const Eigen::Vector2d to(run.coordinates.x[i], run.coordinates.y[i]);
    draw(images.raw, from);
    draw(images.stabilized, to);
    ++images.events;
    if (!has_truth) continue;
    const Eigen::Quaterniond steady_from_camera =
        steady_from_world * truth.at_clamped(seconds_from_ns(run.events[i].t_ns)).rotation();
    const Eigen::Vector2d expected = camera.project(steady_from_camera * camera.ray(from));
    draw(images.truth, expected);
    if ((to - expected).norm() <= 1) ++images.within_1px;
  }
  return images;
}

double sharpness(const ImageF& image) {
  double sum = 0, squares = 0;
  for (const float value : image.pixels()) {
    sum += static_cast<double>(value);
    squares += static_cast<double>(value) * static_cast<double>(value);
  }
  const auto n = static_cast<double>(image.size());
  return n > 0 ? squares / n - sum * sum / (n * n) : 0;
}

namespace {

struct Window {
  double raw = 0, stabilized = 0, truth = 0;
  std::size_t events = 0, within = 0;
};

/// Of the windows whose events as they fired are sharp at all; nullopt where none are.
std::optional<double> mean_sharpening(const std::vector<Window>& windows) {
  double sum = 0, count = 0;
  for (const Window& window : windows) {
    if (!(window.raw > 0)) continue;
    sum += window.stabilized / window.raw;
    ++count;
  }
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

}  // namespace

Metrics score_stabilization(const StabilizedRun& run, const Dataset& dataset) {
  std::vector<Window> windows(run.windows.size());
  parallel_for(windows.size(), [&](std::size_t i) {
    const WindowImages images = images_of(run, i, dataset);
    windows[i] = {sharpness(images.raw), sharpness(images.stabilized), sharpness(images.truth),
                  images.events, images.within_1px};
  });
  Metrics metrics;
  if (windows.empty()) return metrics;
  Window sum;
  for (const Window& window : windows) {
    sum.raw += window.raw;
    sum.stabilized += window.stabilized;
    sum.truth += window.truth;
    sum.events += window.events;
    sum.within += window.within;
  }
  const auto count = static_cast<double>(windows.size());
  metrics.set("sharpness.raw", sum.raw / count);
  metrics.set("sharpness.stabilized", sum.stabilized / count);
  metrics.set("sharpness.fwl", mean_sharpening(windows));
  if (dataset.groundtruth().empty()) return metrics;
  metrics.set("sharpness.truth", sum.truth / count);
  if (sum.events > 0)
    metrics.set("stabilization.within_1px",
                static_cast<double>(sum.within) / static_cast<double>(sum.events));
  return metrics;
}

}  // namespace saccade
