#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "eval/view/view_session.h"

namespace saccade {

constexpr std::uint64_t kMostClipEvents = 1'000'000;
constexpr std::size_t kMostClipPictures = 60;  ///< of every list of frames, depth maps, views

/// Writes the page with all that it shows inside, so that it needs no program and no network: at
/// most about kMostClipEvents events, of more every n-th, and kMostClipPictures of every list of
/// pictures; the page says so. Returns what was left out as a sentence. InputError for a folder that
/// is still being written.
[[nodiscard]] std::string write_clip(ViewSession& session, const std::filesystem::path& file);

}  // namespace saccade
