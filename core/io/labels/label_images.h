#pragma once

#include <cstddef>
#include <filesystem>
#include <mutex>
#include <utility>
#include <vector>

#include "core/image.h"
#include "core/io/files/file_list.h"
#include "core/io/images/exr_file.h"
#include "core/io/images/image_file.h"

namespace saccade {

/// What is in the pixels of an image.
struct InstanceMask {
  ImageU16 instances;  ///< 0 = background
  ImageU8 classes;     ///< 0 = none
};

/// Unit normals in the camera's frame, towards the camera; zero where nothing was hit.
struct NormalMap {
  ImageF x, y, z;
};

/// Writes masks/instance_%08d.png (16 bits), masks/class_%08d.png (8 bits) and
/// normals/normals_%08d.exr (channels X, Y and Z) of a dataset folder, and their lists masks.txt
/// (which names the instances) and normals.txt. Images are written by index (0, 1, 2 ... in order
/// of time, none left out); thread-safe for different indices.
class LabelImageWriter {
 public:
  explicit LabelImageWriter(std::filesystem::path folder) : folder_(std::move(folder)) {}

  void write_mask(std::size_t index, double t_s, const InstanceMask& mask);
  void write_normals(std::size_t index, double t_s, const NormalMap& normals);
  /// The lists of what was written, if anything.
  void finish();

 private:
  void store(std::vector<StampedFile>& list, std::size_t index, StampedFile file);

  std::filesystem::path folder_;
  std::mutex mutex_;  ///< of the lists
  std::vector<StampedFile> masks_, normals_;
};

/// By the file that masks.txt names. InputError with the path where it or that of the classes is
/// missing or of another kind.
[[nodiscard]] InstanceMask read_mask(const std::filesystem::path& instances);
[[nodiscard]] NormalMap read_normals(const std::filesystem::path& file);

}  // namespace saccade
