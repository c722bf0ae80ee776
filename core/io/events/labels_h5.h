#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "core/io/tables/h5_table.h"

namespace saccade {

/// What makes an event fire: the signal, the leaking reference, shot noise, a hot pixel.
constexpr std::array<std::string_view, 4> kEventOriginNames{"signal", "leak", "shot", "hot"};

/// What a simulator knows about events beyond what a sensor tells; one entry per event in each.
struct EventLabels {
  std::vector<float> depth;   ///< z of the surface in the pixel [m], 0 = nothing hit
  std::vector<float> flow_x;  ///< its motion in the image [px/s]
  std::vector<float> flow_y;
  std::vector<std::int32_t> object;     ///< index into the scene's meshes, -1 = nothing hit
  std::vector<std::uint16_t> instance;  ///< id in labels.yaml, 0 = nothing hit
  std::vector<std::uint8_t> class_id;   ///< that of its instance, 0 = none
  std::vector<std::uint8_t> origin;     ///< index into kEventOriginNames

  [[nodiscard]] std::size_t size() const { return origin.size(); }
  void resize(std::size_t count);
};

/// Labels begin <= i < end of a file that LabelsH5Writer wrote; `count`: of the events that they
/// belong to. Files of version 0.2 and before have no instances: there each object is one, without a
/// class. InputError with the place for columns that are missing, of another type or length.
[[nodiscard]] EventLabels read_labels_h5(const std::filesystem::path& file, std::uint64_t count,
                                         std::uint64_t begin, std::uint64_t end);

/// Writes labels.h5: /labels/depth, flow_x, flow_y (f32), object (i32), instance (u16),
/// class (u8) and origin (u8), in the
/// events' order.
class LabelsH5Writer {
 public:
  explicit LabelsH5Writer(const std::filesystem::path& file);
  /// Labels of the events that follow those before.
  void append(const EventLabels& labels);
  void close() { table_.close(); }

 private:
  H5TableWriter table_;
};

}  // namespace saccade
