#include "core/io/events/prophesee/evt3.h"
#include "core/io/events/prophesee/evt3_decoder.h"
#include "core/io/events/prophesee/raw_reader.h"

namespace saccade {

std::unique_ptr<EventReader> open_evt3(const std::filesystem::path& file, SensorSize size,
                                       TimeWindow window) {
  return std::make_unique<RawEventReader<Evt3Decoder>>(file, size, window);
}

}  // namespace saccade
