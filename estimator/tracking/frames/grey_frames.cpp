#include "estimator/tracking/frames/grey_frames.h"

#include <fmt/core.h>

#include <cmath>
#include <string>

#include "core/config/document.h"
#include "core/error.h"
#include "core/io/images/image_file.h"
#include "estimator/tracking/reference_view.h"

namespace saccade {
namespace {

/// Stamps are rounded: a frame this much before the window belongs to it.
constexpr double kRounding_s = 1e-6;

/// The entry of a map; nullptr where there is none.
const config::Node* value_of(const config::Node* map, std::string_view key) {
  const config::Entry* entry = map == nullptr ? nullptr : map->find(key);
  return entry == nullptr ? nullptr : &entry->value;
}

double number(const config::Node& node, const std::string& source) {
  try {
    return std::stod(node.text);
  } catch (const std::exception&) {
    throw InputError(source, fmt::format("is {}, not a number", node.shown()));
  }
}

/// The tone curve of the pictures, `frames.gain` and `frames.gamma` of the simulation.
ToneCurve tone_of(const Dataset& dataset) {
  ToneCurve tone;
  if (!dataset.record() || dataset.record()->config_yaml.empty()) return tone;
  const std::string source = (dataset.folder() / "dataset.yaml").string();
  const config::Document document = config::parse(dataset.record()->config_yaml, source);
  const config::Node* frames = value_of(&document.root(), "frames");
  if (const config::Node* gain = value_of(frames, "gain"))
    tone.gain = number(*gain, source + ": frames.gain");
  const config::Node* gamma = value_of(frames, "gamma");
  if (gamma != nullptr && gamma->text != "srgb")
    tone.gamma = number(*gamma, source + ": frames.gamma");
  return tone;
}

ImageU8 read_codes(const StampedFile& frame, const PinholeCamera& camera) {
  if (frame.file.extension() == ".exr")
    throw InputError(frame.file.string(), "is no 8-bit picture, which method: frames tracks");
  ImageU8 codes = read_image_grey(frame.file);
  if (codes.width() != camera.width || codes.height() != camera.height)
    throw InputError(frame.file.string(),
                     fmt::format("is {} x {}, the sensor {} x {}", codes.width(), codes.height(),
                                 camera.width, camera.height));
  return codes;
}

}  // namespace

ImageF log_intensity_of_codes(const ImageU8& codes, const ToneCurve& tone, double log_eps) {
  std::array<float, 256> values = linear_of_codes(tone);
  for (float& value : values)
    value = static_cast<float>(std::log(static_cast<double>(value) + log_eps));
  values.front() = values.back() = kUnknownLogIntensity;
  ImageF image(codes.width(), codes.height());
  for (std::size_t i = 0; i < codes.size(); ++i) image.pixels()[i] = values[codes.pixels()[i]];
  return image;
}

std::vector<GreyFrame> load_grey_frames(const Dataset& dataset, const PinholeCamera& camera,
                                        double start_s, double end_s) {
  const ToneCurve tone = tone_of(dataset);
  std::vector<GreyFrame> frames;
  for (const StampedFile& frame : dataset.frames()) {
    if (frame.t_s < start_s - kRounding_s || frame.t_s > end_s + kRounding_s) continue;
    const ImageF values =
        log_intensity_of_codes(read_codes(frame, camera), tone, dataset.facts().log_eps);
    frames.push_back(
        {ns_from_seconds(frame.t_s), undistort_bilinear(values, camera, kUnknownLogIntensity)});
  }
  if (frames.empty())
    throw InputError(dataset.folder().string(), "holds no frames in the window to be tracked");
  return frames;
}

}  // namespace saccade
