#include "estimator/run/sensor_input.h"

namespace saccade {

std::optional<SensorFile> describe_sensor(config::Fields& fields,
                                          std::optional<std::filesystem::path>& sensor) {
  fields
      .path("sensor", sensor,
            "File of a calibrated sensor (`saccade calibrate`), from which thresholds and their "
            "mismatch are taken unless keys state them; ~ takes none.")
      .must_exist();
  if (!fields.has("sensor") || !sensor) return std::nullopt;
  return read_sensor_file(*sensor);
}

}  // namespace saccade
