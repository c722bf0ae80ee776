#pragma once

#include <filesystem>
#include <optional>

#include "core/config/fields.h"
#include "core/io/sensor_file.h"

namespace saccade {

/// Describes the key `sensor` of a module's configuration and, where it is stated, reads the file:
/// its values are the defaults of keys that are described after it, so that stated keys win and
/// run.yaml shows what was taken. nullopt: none stated.
[[nodiscard]] std::optional<SensorFile> describe_sensor(
    config::Fields& fields, std::optional<std::filesystem::path>& sensor);

}  // namespace saccade
