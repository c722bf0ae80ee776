#include "core/io/labels/optical_flow_file.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "core/check.h"
#include "core/error.h"
#include "core/event.h"
#include "core/io/files/atomic_file.h"
#include "core/io/tables/text_table.h"

namespace saccade {
namespace fs = std::filesystem;
namespace {

constexpr const char* kFlowColumns = "from to file";
constexpr double kScale = 128;
constexpr double kZero = 32768;
constexpr double kHighest = 65535;

double code_of(float displacement_px) {
  return std::round(kScale * static_cast<double>(displacement_px)) + kZero;
}

bool fits(double code) { return code >= 0 && code <= kHighest; }

float displacement_of(std::uint16_t code) {
  return static_cast<float>((static_cast<double>(code) - kZero) / kScale);
}

fs::path name_of(const char* direction, std::size_t index) {
  return fs::path("optical_flow") / fmt::format("{}_{:08}.png", direction, index);
}

/// "00000012" of forward_00000012.png.
std::string number_of(const fs::path& forward) {
  const std::string stem = forward.stem().string();
  constexpr std::size_t kPrefix = sizeof("forward_") - 1;
  if (!stem.starts_with("forward_"))
    throw InputError(forward.string(), "is no forward flow: forward_NNNNNNNN.png");
  return stem.substr(kPrefix);
}

OpticalFlow read_direction(const fs::path& folder, const std::string& direction,
                           const std::string& number) {
  const fs::path occlusion = folder / (direction + "_occlusion_" + number + ".png");
  OpticalFlow flow =
      flow_from_dsec_codes(read_image_rgb16(folder / (direction + "_" + number + ".png")));
  flow.covisibility = read_image_grey(occlusion);
  if (flow.covisibility.width() != flow.u.width() || flow.covisibility.height() != flow.u.height())
    throw InputError(occlusion.string(), "has another size than its optical flow");
  return flow;
}

}  // namespace

ImageRgb16 dsec_codes(const OpticalFlow& flow) {
  ImageRgb16 codes(flow.u.width(), flow.u.height());
  for (std::size_t i = 0; i < codes.size(); ++i) {
    if (flow.is_valid.pixels()[i] == 0) continue;
    const double u = code_of(flow.u.pixels()[i]);
    const double v = code_of(flow.v.pixels()[i]);
    if (fits(u) && fits(v))
      codes.pixels()[i] = {static_cast<std::uint16_t>(u), static_cast<std::uint16_t>(v), 1};
  }
  return codes;
}

OpticalFlow flow_from_dsec_codes(const ImageRgb16& codes) {
  const int width = codes.width();
  const int height = codes.height();
  OpticalFlow flow{ImageF(width, height), ImageF(width, height), ImageU8(width, height), {}};
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const auto& [u, v, valid] = codes.pixels()[i];
    if (valid == 0) continue;
    flow.is_valid.pixels()[i] = 1;
    flow.u.pixels()[i] = displacement_of(u);
    flow.v.pixels()[i] = displacement_of(v);
  }
  return flow;
}

void OpticalFlowWriter::write(std::size_t index, double from_s, double to_s,
                              const OpticalFlowPair& pair) {
  write_png(folder_ / name_of("forward", index), dsec_codes(pair.forward));
  write_png(folder_ / name_of("backward", index), dsec_codes(pair.backward));
  write_png(folder_ / name_of("forward_occlusion", index), pair.forward.covisibility);
  write_png(folder_ / name_of("backward_occlusion", index), pair.backward.covisibility);
  const std::scoped_lock lock(mutex_);
  if (entries_.size() <= index) entries_.resize(index + 1);
  entries_[index] = {from_s, to_s, name_of("forward", index)};
}

void OpticalFlowWriter::finish() {
  if (entries_.empty()) return;
  std::string text = fmt::format("# {}\n", kFlowColumns);
  for (const OpticalFlowEntry& entry : entries_) {
    SACCADE_CHECK(!entry.forward.empty());
    append_decimal_seconds(ns_from_seconds(entry.from_s), text);
    text += ' ';
    append_decimal_seconds(ns_from_seconds(entry.to_s), text);
    text += fmt::format(" {}\n", entry.forward.generic_string());
  }
  write_atomically(folder_ / "optical_flow.txt", text);
}

std::vector<OpticalFlowEntry> read_optical_flow_list(const fs::path& list) {
  std::vector<OpticalFlowEntry> entries;
  for_each_row(list, [&](TextRow& row) {
    OpticalFlowEntry entry;
    entry.from_s = seconds_from_ns(row.seconds("from"));
    entry.to_s = seconds_from_ns(row.seconds("to"));
    entry.forward = list.parent_path() / row.word("file");
    row.expect_end(kFlowColumns);
    if (!(entry.from_s < entry.to_s)) row.fail("the interval is empty: 'from' must be below 'to'");
    if (!entries.empty() && !(entries.back().from_s < entry.from_s))
      row.fail("times must increase");
    entries.push_back(std::move(entry));
    return true;
  });
  return entries;
}

OpticalFlowPair read_optical_flow(const fs::path& forward) {
  const std::string number = number_of(forward);
  OpticalFlowPair pair{read_direction(forward.parent_path(), "forward", number),
                       read_direction(forward.parent_path(), "backward", number)};
  return pair;
}

}  // namespace saccade
