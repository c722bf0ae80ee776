#include "core/io/labels/label_images.h"

#include <fmt/format.h>

#include <array>
#include <string>

#include "core/check.h"
#include "core/error.h"

namespace saccade {
namespace fs = std::filesystem;
namespace {

void write_list_if_any(const fs::path& list, const std::vector<StampedFile>& files) {
  for (const StampedFile& file : files) SACCADE_CHECK(!file.file.empty());
  if (!files.empty()) write_file_list(list, files);
}

/// masks/class_00000012.png beside masks/instance_00000012.png.
fs::path classes_beside(const fs::path& instances) {
  constexpr std::size_t kPrefix = sizeof("instance_") - 1;
  const std::string name = instances.filename().string();
  if (!name.starts_with("instance_"))
    throw InputError(instances.string(), "is no mask of instances: instance_NNNNNNNN.png");
  return instances.parent_path() / ("class_" + name.substr(kPrefix));
}

}  // namespace

void LabelImageWriter::store(std::vector<StampedFile>& list, std::size_t index, StampedFile file) {
  const std::scoped_lock lock(mutex_);
  if (list.size() <= index) list.resize(index + 1);
  list[index] = std::move(file);
}

void LabelImageWriter::write_mask(std::size_t index, double t_s, const InstanceMask& mask) {
  const fs::path instances = folder_ / "masks" / fmt::format("instance_{:08}.png", index);
  write_png(instances, mask.instances);
  write_png(classes_beside(instances), mask.classes);
  store(masks_, index, {t_s, instances});
}

void LabelImageWriter::write_normals(std::size_t index, double t_s, const NormalMap& normals) {
  const fs::path file = folder_ / "normals" / fmt::format("normals_{:08}.exr", index);
  const std::array<ExrChannel, 3> channels{ExrChannel{"X", normals.x}, ExrChannel{"Y", normals.y},
                                           ExrChannel{"Z", normals.z}};
  write_exr(file, channels);
  store(normals_, index, {t_s, file});
}

void LabelImageWriter::finish() {
  write_list_if_any(folder_ / "masks.txt", masks_);
  write_list_if_any(folder_ / "normals.txt", normals_);
}

InstanceMask read_mask(const fs::path& instances) {
  const fs::path classes = classes_beside(instances);
  InstanceMask mask{read_image_u16(instances), read_image_grey(classes)};
  if (mask.instances.width() != mask.classes.width() ||
      mask.instances.height() != mask.classes.height())
    throw InputError(classes.string(), "has another size than the mask of instances");
  return mask;
}

NormalMap read_normals(const fs::path& file) {
  std::vector<ExrChannel> channels = read_exr_channels(file);
  if (channels.size() != 3 || channels[0].name != "X" || channels[1].name != "Y" ||
      channels[2].name != "Z")
    throw InputError(file.string(), "holds no normals: channels X, Y and Z");
  return {std::move(channels[0].image), std::move(channels[1].image), std::move(channels[2].image)};
}

}  // namespace saccade
