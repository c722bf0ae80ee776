#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"

namespace saccade {

using RgbF = std::array<float, 3>;
using ImageRgbF = Image<RgbF>;

/// One named channel of an OpenEXR file.
struct ExrChannel {
  std::string name;
  ImageF image;
};

/// All channels of a file (float, half or integer samples; scanlines or tiles; data window only),
/// in the alphabetical order of the format. InputError with the path when it is missing or
/// malformed.
[[nodiscard]] std::vector<ExrChannel> read_exr_channels(const std::filesystem::path& file);
/// One plane: the file's only channel, else "Y", else "Z", else the luminance of R, G and B.
[[nodiscard]] ImageF read_exr(const std::filesystem::path& file);
/// R, G and B, or one plane three times.
[[nodiscard]] ImageRgbF read_exr_rgb(const std::filesystem::path& file);
[[nodiscard]] ImageRgbF decode_exr_rgb(std::span<const std::byte> bytes,
                                       const std::string& location);

/// Float32 with lossless ZIP compression; channels of the same size with different names.
void write_exr(const std::filesystem::path& file, std::span<const ExrChannel> channels);
/// One channel: "Y" for radiance, "Z" for depth.
void write_exr(const std::filesystem::path& file, const ImageF& image, const std::string& channel);
void write_exr(const std::filesystem::path& file, const ImageRgbF& image);

/// A motion field [px/s], channels "u" (to the right) and "v" (down).
struct FlowField {
  ImageF u;
  ImageF v;
};
[[nodiscard]] FlowField read_exr_flow(const std::filesystem::path& file);
void write_exr_flow(const std::filesystem::path& file, const FlowField& flow);

}  // namespace saccade
