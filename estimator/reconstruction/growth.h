#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "core/config/fields.h"
#include "core/event.h"
#include "core/image.h"

namespace saccade {

/// An image after its first events.
struct GrowthPicture {
  std::size_t events = 0;
  ImageF log_image;
};

/// Says an error of numbers of events, `growth` of a configuration, that are not above 0.
void check_growth(config::Fields& fields, const std::vector<std::int64_t>& counts);

/// The image from the first `counts[i]` > 0 of some events, as in thesis figs. 8.14 and 8.15. In
/// parallel.
[[nodiscard]] std::vector<GrowthPicture> grow(
    std::span<const Event> events, const std::vector<std::int64_t>& counts,
    const std::function<ImageF(std::span<const Event>)>& log_image_of);

/// growth/growth_%09d.png by number of events; nothing where there are none.
void write_growth(const std::filesystem::path& folder, std::span<const GrowthPicture> growth);

}  // namespace saccade
