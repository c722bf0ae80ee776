#include "estimator/reconstruction/growth.h"

#include <fmt/core.h>

#include <algorithm>

#include "core/io/image_file.h"
#include "core/parallel.h"
#include "estimator/reconstruction/reconstruction_output.h"

namespace saccade {

std::vector<GrowthPicture> grow(std::span<const Event> events,
                                const std::vector<std::int64_t>& counts,
                                const std::function<ImageF(std::span<const Event>)>& log_image_of) {
  std::vector<GrowthPicture> pictures(counts.size());
  parallel_for(counts.size(), [&](std::size_t i) {
    const auto count =
        std::min(events.size(), static_cast<std::size_t>(std::max<std::int64_t>(counts[i], 1)));
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
