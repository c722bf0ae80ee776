#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <utility>
#include <vector>

#include "core/image.h"
#include "core/io/images/image_file.h"

namespace saccade {

/// Whether the point that a pixel shows is seen in the other image; the codes of the masks.
enum class Covisibility : std::uint8_t {
  kVisible = 0,
  kOutside = 128,   ///< beyond the border of the other image, or behind its camera
  kOccluded = 255,  ///< behind something nearer
};

/// Displacement [px] of every pixel's point from one instant to another, on the distorted images.
struct OpticalFlow {
  ImageF u, v;           ///< to the right and down
  ImageU8 is_valid;      ///< 1 or 0: where the displacement is defined and can be stored
  ImageU8 covisibility;  ///< Covisibility
};

/// Flow over one interval in both directions: `forward` of the pixels of the first image, to the
/// second; `backward` of those of the second, to the first.
struct OpticalFlowPair {
  OpticalFlow forward, backward;
};

/// An interval and the file of its forward flow.
struct OpticalFlowEntry {
  double from_s = 0, to_s = 0;
  std::filesystem::path forward;
};

/// As DSEC stores it (Gehrig et al., 3DV 2021): 16-bit PNG with the channels
///   R = round(128 u) + 2^15,   G = round(128 v) + 2^15,   B = valid (0 or 1)
/// What does not fit into 16 bits is not valid.
[[nodiscard]] ImageRgb16 dsec_codes(const OpticalFlow& flow);
/// Of what was not valid the displacement is 0; `covisibility` stays empty.
[[nodiscard]] OpticalFlow flow_from_dsec_codes(const ImageRgb16& codes);

/// Writes optical_flow/{forward,backward}_%08d.png and, beside them,
/// {forward,backward}_occlusion_%08d.png, and their list optical_flow.txt. Thread-safe for
/// different indices (0, 1, 2 ..., none left out).
class OpticalFlowWriter {
 public:
  explicit OpticalFlowWriter(std::filesystem::path folder) : folder_(std::move(folder)) {}
  void write(std::size_t index, double from_s, double to_s, const OpticalFlowPair& pair);
  /// The list, if anything was written.
  void finish();

 private:
  std::filesystem::path folder_;
  std::mutex mutex_;  ///< of the list
  std::vector<OpticalFlowEntry> entries_;
};

/// Lines `from to file` below a comment that names the columns; files relative to the list's folder.
/// InputError with `file:line` for intervals that are empty or not in order.
[[nodiscard]] std::vector<OpticalFlowEntry> read_optical_flow_list(
    const std::filesystem::path& list);
/// All four files of an interval. InputError with the path of what is missing or of another kind or
/// size.
[[nodiscard]] OpticalFlowPair read_optical_flow(const std::filesystem::path& forward);

}  // namespace saccade
