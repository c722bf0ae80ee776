#include "estimator/refinement/poses/increment_images.h"

#include <algorithm>

#include "core/check.h"
#include "estimator/refinement/poses/pixel_choice.h"

namespace saccade {
namespace {

constexpr std::size_t kNotChosen = static_cast<std::size_t>(-1);

/// The pixels that are used, and their numbers by index on the sensor; kNotChosen of the
/// others.
std::vector<std::size_t> choose(const PinholeCamera& camera, double fraction,
                                IncrementImages& images) {
  const UndistortionTable undistortion(camera);
  const PinholeCamera undistorted = camera.undistorted();
  std::vector<std::size_t> numbers;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const bool chosen = is_chosen(numbers.size(), fraction);
      numbers.push_back(chosen ? images.pixels.size() : kNotChosen);
      if (!chosen) continue;
      const Eigen::Vector2f& pixel = undistortion(x, y);
      images.pixels.push_back({pixel, undistorted.ray(pixel.cast<double>())});
    }
  return numbers;
}

}  // namespace

IncrementImages observe_increments(std::span<const Event> events, const PinholeCamera& camera,
                                   const EventContrast& contrast, int window_events,
                                   int increments) {
  SACCADE_CHECK(window_events > 0 && increments > 0);
  IncrementImages images;
  if (events.empty()) return images;
  const std::size_t windows =
      std::max<std::size_t>(1, events.size() / static_cast<std::size_t>(window_events));
  const double all = static_cast<double>(windows) * camera.width * camera.height;
  const auto numbers = choose(camera, increments / all, images);
  images.increments.resize(windows * images.pixels.size());
  images.times_s.push_back(seconds_from_ns(events.front().t_ns));
  for (std::size_t w = 0; w < windows; ++w) {
    const std::size_t first = w * events.size() / windows;
    const std::size_t end = (w + 1) * events.size() / windows;
    for (const Event& event : events.subspan(first, end - first)) {
      const std::size_t index =
          static_cast<std::size_t>(event.y) * static_cast<std::size_t>(camera.width) + event.x;
      if (numbers[index] == kNotChosen) continue;
      images.increments[w * images.pixels.size() + numbers[index]] +=
          static_cast<float>(event.polarity > 0 ? contrast.on : -contrast.off);
    }
    images.times_s.push_back(seconds_from_ns(events[end - 1].t_ns));
  }
  return images;
}

}  // namespace saccade
