#include "estimator/reconstruction/reconstruction_output.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "core/io/images/exr_file.h"
#include "core/io/images/image_file.h"
#include "core/process/parallel.h"

namespace saccade {
namespace {

ImageF as_float(const ImageU8& mask) {
  ImageF image(mask.width(), mask.height());
  for (std::size_t i = 0; i < mask.size(); ++i)
    image.pixels()[i] = static_cast<float>(mask.pixels()[i]);
  return image;
}

}  // namespace

ImageU8 grey_picture(const ImageF& log_image, const ImageU8& observed) {
  std::vector<float> values;
  for (std::size_t i = 0; i < log_image.size(); ++i)
    if (observed.empty() || observed.pixels()[i] != 0) values.push_back(log_image.pixels()[i]);
  if (values.empty()) values.assign(log_image.pixels().begin(), log_image.pixels().end());
  const auto at = [&values](double ratio) {
    const auto k = static_cast<std::ptrdiff_t>(ratio * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + k, values.end());
    return values[static_cast<std::size_t>(k)];
  };
  const float low = at(0.005);
  const float range = std::max(at(0.995) - low, 1e-6F);
  ImageU8 picture(log_image.width(), log_image.height());
  for (std::size_t i = 0; i < log_image.size(); ++i)
    picture.pixels()[i] = static_cast<std::uint8_t>(
        std::lround(255 * std::clamp((log_image.pixels()[i] - low) / range, 0.0F, 1.0F)));
  return picture;
}

void write_log_image(const std::filesystem::path& file, const ImageF& log_image,
                     const ImageU8& observed) {
  const ExrChannel channels[] = {{"L", log_image}, {"observed", as_float(observed)}};
  write_exr(file, channels);
}

void write_image_view(const Reconstruction& result, const RunView& view) {
  const ExrChannel gradient[] = {{"gx", result.gradient_x},
                                 {"gy", result.gradient_y},
                                 {"Pxx", result.covariance_xx},
                                 {"Pxy", result.covariance_xy},
                                 {"Pyy", result.covariance_yy}};
  write_exr(view.gradient, gradient);
  write_log_image(view.image, result.log_image, result.observed);
  write_png(std::filesystem::path(view.image).replace_extension(".png"),
            grey_picture(result.log_image, result.observed));
}

void describe_snapshots(config::Fields& fields, std::vector<std::int64_t>& counts) {
  fields
      .value("snapshot_events", counts,
             "Numbers of events after which a picture of the image is kept in growth/; an empty "
             "list keeps none. Each takes as long as an image of so many events.")
      .above(0);
}

std::vector<Snapshot> take_snapshots(
    std::span<const Event> events, const std::vector<std::int64_t>& counts,
    const std::function<ImageF(std::span<const Event>)>& log_image_of) {
  std::vector<Snapshot> snapshots(counts.size());
  parallel_for(counts.size(), [&](std::size_t i) {
    const std::size_t count = std::min(events.size(), static_cast<std::size_t>(counts[i]));
    snapshots[i] = {count, log_image_of(events.first(count))};
  });
  return snapshots;
}

void write_snapshots(const std::filesystem::path& folder, std::span<const Snapshot> snapshots) {
  if (snapshots.empty()) return;
  std::filesystem::create_directories(folder / "growth");
  for (const Snapshot& snapshot : snapshots)
    write_png(folder / "growth" / fmt::format("growth_{:09}.png", snapshot.events),
              grey_picture(snapshot.log_image, {}));
}

void write_reconstruction(const std::filesystem::path& folder,
                          std::span<const ReconstructionWindow> windows,
                          std::span<const Reconstruction> results,
                          std::span<const Snapshot> snapshots) {
  std::filesystem::create_directories(folder / "gradient");
  std::filesystem::create_directories(folder / "image");
  std::vector<RunView> views;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    RunView view;
    view.t_s = windows[i].reference_s;
    view.world_from_camera = windows[i].world_from_reference();
    view.start_s = seconds_from_ns(windows[i].events.front().t_ns);
    view.end_s = seconds_from_ns(windows[i].events.back().t_ns);
    view.gradient = folder / "gradient" / fmt::format("gradient_{:08}.exr", i);
    view.image = folder / "image" / fmt::format("image_{:08}.exr", i);
    write_image_view(results[i], view);
    views.push_back(view);
  }
  write_view_list(folder / "views.yaml", views);
  write_snapshots(folder, snapshots);
}

}  // namespace saccade
