#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace saccade {

/// Writes FOLDER/card.md from a manifest (write_manifest()): what the datasets are, how they are made
/// again, their numbers and sizes by scene and split, statistics of their rates and of the sampled
/// numbers; and FOLDER/card.png, events, frame and depth of the middle of up to six datasets, evenly
/// spaced. Without a dataset that exists there is no picture.
void write_dataset_card(const nlohmann::ordered_json& manifest,
                        const std::filesystem::path& folder);

/// The text of the card; `has_picture`: with a link to card.png.
[[nodiscard]] std::string dataset_card(const nlohmann::ordered_json& manifest, bool has_picture);

}  // namespace saccade
