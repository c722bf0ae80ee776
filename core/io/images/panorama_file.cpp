#include "core/io/images/panorama_file.h"

#include "core/config/config.h"
#include "core/io/files/atomic_file.h"

namespace saccade {

void describe(config::Fields& fields, Panorama& panorama) {
  fields.value("around", panorama.around, "columns of the whole sphere [px]").required();
  fields.value("left", panorama.left, "first column within the whole").required();
  fields.value("top", panorama.top, "first row").required();
  fields.value("width", panorama.width, "[px]").required();
  fields.value("height", panorama.height, "[px]").required();
}

Panorama read_panorama(const std::filesystem::path& file) {
  const auto panorama = config::read<Panorama>(config::load(file));
  panorama.check(file.string());
  return panorama;
}

void write_panorama(const std::filesystem::path& file, const Panorama& panorama) {
  write_atomically(file, config::print(panorama));
}

}  // namespace saccade
