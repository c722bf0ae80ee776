#include "estimator/reconstruction/growth.h"

#include <fmt/core.h>

#include <algorithm>

#include "core/io/images/image_file.h"
#include "core/process/parallel.h"
#include "estimator/reconstruction/reconstruction_output.h"

namespace saccade {

void check_growth(config::Fields& fields, const std::vector<std::int64_t>& counts) {
  for (const std::int64_t count : counts)
    fields.expect(count > 0, "growth", fmt::format("{} is no number of events above 0", count));
}

std::vector<GrowthPicture> grow(std::span<const Event> events,
                                const std::vector<std::int64_t>& counts,
                                const std::function<ImageF(std::span<const Event>)>& log_image_of) {
  std::vector<GrowthPicture> pictures(counts.size());
  parallel_for(counts.size(), [&](std::size_t i) {
    const std::size_t count = std::min(events.size(), static_cast<std::size_t>(counts[i]));
    pictures[i] = {count, log_image_of(events.first(count))};
  });
  return pictures;
}

void write_growth(const std::filesystem::path& folder, std::span<const GrowthPicture> growth) {
  if (growth.empty()) return;
  std::filesystem::create_directories(folder / "growth");
  for (const GrowthPicture& picture : growth)
    write_png(folder / "growth" / fmt::format("growth_{:09}.png", picture.events),
              grey_picture(picture.log_image, {}));
}

}  // namespace saccade
